// SPDX-License-Identifier: MIT
#include "tools/workprecision/reference_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "lattice/error.hpp"
#include "schemes/state.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/seconds_since.hpp"
#include "tools/rows/initial_rows.hpp"

namespace delf {

namespace {

using Clock = std::chrono::steady_clock;

// The last row, or nothing if the scheme cannot give it at this Courant number.
std::optional<std::vector<double>> last_row(const WorkPrecisionEntry& scheme, const Scene& scene, int sites,
                                            double courant, double until, int d, const RunLimit& limit) {
  const Lattice lattice = lattice_of(scene, sites);
  const double h = lattice.space() == Space::point ? courant * scene.problem.time_step : courant * lattice.space_step();
  const auto steps = std::max<std::int64_t>(4, std::llround(until / h));
  try {
    const auto started = scheme.start({sites, steps, until / static_cast<double>(steps)});
    started->advance(steps - started->newest(), limit);
    if (started->newest() != steps) return std::nullopt;
    std::vector<double> row(sites * d);
    started->copy(row);
    return row;
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::optional<Reference> refined(const WorkPrecisionEntry& scheme, const Scene& scene,
                                 const WorkPrecisionRequest& request, double courant, Clock::time_point until,
                                 const RunLimit& limit) {
  const bool point = scene.problem.lattice.space() == Space::point;
  const double monodromy = InitialRows(scene).monodromy();
  const int d = make_state(scene.initial, scene.problem.lattice)->components();
  const int ends = scene.problem.lattice.is_circle() ? 0 : 1;
  const int finest = request.sites.empty() ? scene.problem.lattice.sites() : std::ranges::max(request.sites);
  int sites = point ? 1 : 2 * std::max(2, (finest - ends) / (2 * scheme.nodes)) + ends;
  std::optional<Reference> best;
  std::optional<std::vector<double>> before;
  for (double change = 0, cost = 0; !best || seconds_since(until) + 4 * cost < 0; courant *= point ? 0.5 : 1) {
    const auto begin = Clock::now();
    auto row = last_row(scheme, scene, sites, courant, request.until, d, limit);
    cost = seconds_since(begin);
    if (!row) break;
    const Lattice fine = lattice_of(scene, sites);
    ComparedSolution solution = ComparedSolution::reference(fine, d, monodromy, *row);
    if (before) {
      const Lattice coarse = lattice_of(scene, point ? 1 : sites / 2 + ends);
      const double changed = field_error(*before, solution.at(coarse, request.until), 1).linf;
      if (!std::isfinite(changed) || (best && changed > 0.5 * change)) break;  // the floor
      change = changed;
      best = Reference{std::move(solution),
                       fmt::format("{} at N = {}, h/k = {:.3g}; the last doubling of N changed it by {:.2g}",
                                   scheme.name, sites, courant, changed),
                       changed};
      if (point)
        best->words = fmt::format("{} at h = {:.3g} of the scene's; half of that changed it by {:.2g}", scheme.name,
                                  courant, changed);
    }
    before = std::move(row);
    if (Interrupt::asked()) break;
    if (!point) sites = 2 * sites - ends;
  }
  return best;
}

}  // namespace

std::optional<Reference> find_reference(const Scene& scene, const WorkPrecisionRequest& request,
                                        Clock::time_point until, const RunLimit& limit) {
  if (scene.from_file())
    throw scene.settings.error("initial.state", "a file has rows of one lattice only; use a state");
  if (has_exact(scene, request.until))
    return Reference{ComparedSolution::exact(scene, request.until), "the exact solution", 0};
  std::vector<WorkPrecisionEntry> schemes = engine_entries(scene);
  std::erase_if(schemes, [](const WorkPrecisionEntry& c) { return c.rank == 0; });
  std::ranges::stable_sort(schemes, std::greater(), &WorkPrecisionEntry::rank);
  for (const WorkPrecisionEntry& scheme : schemes)
    for (const double courant : {0.25, 0.0625}) {
      if (auto reference = refined(scheme, scene, request, courant, until, limit)) return reference;
      if (Interrupt::asked()) return std::nullopt;
      if (limit.reached())
        throw scene.settings.error(
            "workprecision.budget",
            fmt::format("{} at N = {} and 2N, to compare with, takes too much of it; raise it, or "
                        "lower lattice.sites or run.until",
                        scheme.name, scene.problem.lattice.sites()));
    }
  throw scene.settings.error("initial.state",
                             "no exact solution is known up to run.until, and no scheme gives a fine one to compare "
                             "with; use a shorter run.until or another state");
}

}  // namespace delf
