// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "tools/compare/placed_row.hpp"
#include "tools/rows/initial_rows.hpp"
#include "tools/workprecision/resolution_search.hpp"

namespace delf {
namespace {

std::vector<double> sites_of(const Lattice& lattice) {
  std::vector<double> places;
  for (int i = 0; i < lattice.sites(); ++i) places.push_back(lattice.position(i));
  return places;
}

}  // namespace

TriedRun run_once(const Scene& scene, const std::vector<WorkPrecisionEntry>& entries, std::size_t which,
                  const Resolution& r, double until, const ComparedSolution& solution, const RunLimit& limit) {
  const StepClock clock(scene.problem.threads);
  const Lattice lattice = lattice_of(scene, r.sites);
  const WorkPrecisionEntry& entry = entries[which];
  TriedRun tried{which,
                 r,
                 {.scheme = entry.name,
                  .peer = entry.peer,
                  .processed = entry.processed,
                  .tuned = entry.tuned,
                  .own = entry.own,
                  .sites = r.sites,
                  .space_step = lattice.space_step(),
                  .time_step = r.time_step,
                  .steps = r.steps}};
  WorkPrecisionRun& run = tried.result;
  const double begin = clock.now();
  const auto started = entry.start(r);
  run.seconds_setup = clock.since(begin);
  if (started->newest() >= r.steps - 1) throw BadInput("run.until", "too few steps to be timed");

  constexpr std::int64_t records = 50;
  const double energy0 = started->energy();
  double largest = 0, seconds = 0, forces = 0;
  int looked_at = 0;
  const auto step_to = [&](std::int64_t row) {
    const double from = clock.now();
    started->advance(row - started->newest(), limit);
    seconds += clock.since(from);
    tried.newest = started->newest();
    if (tried.newest != row) return false;
    const double error = std::abs(started->energy() - energy0) / std::abs(energy0);
    if (!(error <= largest)) largest = error;
    forces += started->forces(), ++looked_at;
    return true;
  };
  const std::int64_t every = std::max<std::int64_t>(1, r.steps / records);
  for (std::int64_t row = started->newest() + every; row < r.steps - 1; row += every)
    if (!step_to(row)) return tried;
  const std::size_t d = solution.components();
  std::vector<double> before(at(r.sites) * d), last(before.size());
  if (started->newest() < r.steps - 1 && !step_to(r.steps - 1)) return tried;
  started->copy(before);
  if (!step_to(r.steps)) return tried;
  started->copy(last);
  run.seconds = run.seconds_min = run.seconds_max = seconds;
  run.energy_error_max = largest;
  run.forces_per_step = forces / looked_at;

  if (const std::vector<double> positions = started->positions(); !positions.empty()) {
    // at the sites, wherever they are; of a row of another run piecewise linearly at its own sites
    const FieldError error = solution.is_exact()
                                 ? field_error(PlacedRow{last, positions}, *make_state(scene.initial, lattice), until)
                                 : field_error(linearly_at({last, positions}, sites_of(lattice)),
                                               solution.at(lattice, until), lattice.space_step());
    run.error_linf = error.linf, run.error_l2 = error.l2;
    return tried;
  }
  const std::vector<double> there = solution.at(lattice, until);
  const FieldError error = field_error(last, there, lattice.space_step());
  run.error_linf = error.linf, run.error_l2 = error.l2;
  if (!solution.is_exact() || scene.from_file()) return tried;
  // the same of the exact field, at the same sites and times
  const double monodromy = InitialRows(scene).monodromy();
  const int fields = solution.components();
  const auto centre = [&](const std::vector<double>& field) {
    return gradient_centre(lattice, field, fields, monodromy);
  };
  const double off = separation(lattice, centre(last), centre(there));
  const double off_before = separation(lattice, centre(before), centre(solution.at(lattice, until - r.time_step)));
  run.position_error = std::abs(off);
  run.velocity_error = std::abs(off - off_before) / r.time_step;
  return tried;
}

}  // namespace delf
