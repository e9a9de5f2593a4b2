// SPDX-License-Identifier: MIT
#include "tools/compare/refined_scene.hpp"

#include <chrono>
#include <cmath>
#include <optional>

#include "lattice/index.hpp"
#include "schemes/stepping/evolution.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/seconds_since.hpp"
#include "tools/rows/engine.hpp"
#include "tools/rows/initial_rows.hpp"

namespace delf {

Scene refined(const Scene& scene, int factor) {
  Scene fine = scene;
  const Lattice& lattice = scene.problem.lattice;
  if (lattice.is_circle()) fine.problem.lattice = Lattice::circle(factor * lattice.sites(), lattice.length());
  else if (lattice.space() == Space::interval)
    fine.problem.lattice =
        Lattice::interval(factor * (lattice.sites() - 1) + 1, lattice.length(), lattice.left(), lattice.right());
  fine.problem.time_step = scene.problem.time_step / factor;
  fine.steps = factor * scene.steps;
  fine.every = factor * scene.every;
  return fine;
}

std::vector<double> at_sites_of(const Scene& scene, const std::vector<double>& refined_row, int factor) {
  const Lattice& lattice = scene.problem.lattice;
  if (lattice.space() == Space::point) return refined_row;
  // the finer lattice has factor · N sites round a circle, and factor · (N − 1) + 1 between walls
  const std::size_t sites = lattice.sites(), step = at(factor);
  const std::size_t fields = refined_row.size() / (lattice.is_circle() ? step * sites : step * (sites - 1) + 1);
  std::vector<double> row;
  for (std::size_t i = 0; i < sites; ++i)
    for (std::size_t a = 0; a < fields; ++a) row.push_back(refined_row[i * step * fields + a]);
  return row;
}

QuietEnd run_quietly(const Scene& scene) {
  if (scene.from_file())
    throw scene.settings.error("initial.file",
                               "has rows of one resolution, and finer ones are asked for; give the state as "
                               "formulas, initial.phi and initial.phi_t, or one of `delf list states`");
  const InitialRows initial(scene);
  Simulation simulation = build(scene, initial.winding());
  Measures measures(scene, initial.winding(), simulation);
  initial.start(simulation);
  QuietEnd end;
  end.row.resize(scene.problem.lattice.sites() * simulation.count(Role::field));
  std::vector<double> other(end.row.size());
  const bool two = simulation.starting_rows() > 1;
  std::optional<double> energy_initial;
  const auto see_step = [&](std::int64_t row) {
    if (!measures.sees_steps() || (!scene.until && row > scene.steps)) return;
    simulation.observe(static_cast<int>(simulation.newest() - row), end.row);
    measures.see_step({simulation.time(row), end.row, {}});
  };
  const auto see = [&](std::int64_t row) {
    if (!scene.until && row > scene.steps) return;
    const int back = static_cast<int>(simulation.newest() - row);
    simulation.observe(back, end.row);  // as run records it: the rows of a kernel with the processor undone
    if (measures.empty()) return;
    const double energy = simulation.monitors().energy;
    if (!energy_initial) energy_initial = energy;
    if (two) simulation.observe(back == 0 ? 1 : 0, other);
    measures.see({simulation.time(row), end.row, two ? std::span<const double>(other) : std::span<const double>(),
                  (energy - *energy_initial) / std::abs(*energy_initial)});
  };
  const auto recorded = [&](std::int64_t row) {
    return scene.is_recorded(row, simulation.newest(), simulation.time(simulation.newest()));
  };
  for (std::int64_t row = 0; row <= simulation.newest(); ++row) {
    see_step(row);
    if (recorded(row)) see(row);
  }
  const auto begin = std::chrono::steady_clock::now();
  const auto is_over = [&] { return scene.is_over(simulation.newest(), simulation.time(simulation.newest())); };
  while (!is_over() && !Interrupt::asked()) {
    const std::int64_t row = simulation.newest() + 1;
    simulation.step(scene.until || scene.next_record(row - 1) == row ||
                    (measures.sees_steps() && simulation.is_processed()));
    see_step(row);
    if (recorded(row)) see(row);
  }
  end.seconds = seconds_since(begin);
  end.finished = is_over();
  end.time = simulation.time(scene.until ? simulation.newest() : scene.steps);
  if (simulation.evolution().system().moves() && end.finished) end.placed = placed_row(simulation);
  end.measures = measures.results();
  return end;
}

}  // namespace delf
