// SPDX-License-Identifier: MIT
#include "tools/compare/convergence_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lattice/error.hpp"
#include "tools/compare/field_error.hpp"
#include "tools/compare/refined_scene.hpp"
#include "tools/compare/solution_error.hpp"
#include "tools/report/failure.hpp"
#include "tools/rows/initial_rows.hpp"

namespace delf {

double ConvergenceTable::order() const {
  for (auto level = levels.rbegin(); level != levels.rend(); ++level)
    if (std::isfinite(level->order)) return level->order;
  return ConvergenceLevel::unknown;
}

ConvergenceTable converge(const Scene& scene, int levels) {
  ConvergenceTable table;
  table.exact = has_exact(scene, scene.end());
  if (scene.problem.step_control && !(table.exact && scene.until))
    throw scene.settings.error("lattice.time_steps",
                               "reversible steps end at times of their own; give run.until, and a state whose solution "
                               "is known");
  for (const double phi : InitialRows(scene).row0()) table.size = std::max(table.size, std::abs(phi));
  std::vector<double> before;  // the last row of the level before
  PlacedRow placed_before;
  fill(table, levels, &ConvergenceLevel::linf, [&](int level) {
    const Scene fine = refined(scene, 1 << level);
    const Lattice& lattice = fine.problem.lattice;
    QuietEnd end = run_quietly(fine);
    if (!end.finished) return false;
    ConvergenceLevel now;
    now.sites = lattice.sites(), now.space_step = lattice.space_step(), now.time_step = fine.problem.time_step;
    now.seconds = end.seconds, now.measures = end.measures, now.steps = fine.steps;
    for (const double phi : end.row) now.size = std::max(now.size, std::abs(phi));
    table.size = std::max(table.size, now.size);
    if (table.exact) {
      const FieldError error = end.placed.positions.empty()
                                   ? field_error(end.row, ComparedSolution::exact(fine, end.time).at(lattice, end.time),
                                                 lattice.space_step())
                                   : field_error(end.placed, *make_state(fine.initial, lattice), end.time);
      now.linf = error.linf, now.l2 = error.l2;
    }
    if (level > 0) {
      ConvergenceLevel& coarse = table.levels.back();
      const Scene there = refined(scene, 1 << (level - 1));
      // where sites move, those of the finer row lie elsewhere
      const FieldError error =
          end.placed.positions.empty()
              ? field_error(before, at_sites_of(there, end.row), there.problem.lattice.space_step())
              : field_error(placed_before.fields, linearly_at(end.placed, placed_before.positions),
                            there.problem.lattice.space_step());
      coarse.apart = error.linf;
      if (!table.exact) coarse.linf = error.linf, coarse.l2 = error.l2;
    }
    table.levels.push_back(std::move(now));
    before = std::move(end.row), placed_before = std::move(end.placed);
    return true;
  });
  // A limit of h/k² may have been passed if h/k has not changed, and the coarser steps were stable.
  if (table.status != "done" && table.status != "interrupted")
    table.ended =
        fmt::format("N = {}: {}; h/k^2 doubles from line to line, and may be limited: begin with smaller steps",
                    refined(scene, 1 << table.levels.size()).problem.lattice.sites(), table.ended);
  return table;
}

void fill(ConvergenceTable& table, int levels, double ConvergenceLevel::*norm,
          const std::function<bool(int level)>& add) {
  table.norm = norm;
  for (int level = 0; level < levels && table.status == "done" && table.ended.empty(); ++level) {
    try {
      if (!add(level)) table.status = "interrupted";
    } catch (const NumericalFailure& error) {
      if (level == 0) throw;
      table.status = status_of(error), table.ended = error.what();
    } catch (const BadInput& error) {  // such as more sites than are taken
      if (level == 0) throw;
      table.ended = error.what();
    }
  }
  for (std::size_t i = 0; i + 1 < table.levels.size(); ++i) {
    const double rounding = 1e-12 * table.levels[i + 1].size;  // no order comes of it
    const double a = table.levels[i].*norm, b = table.levels[i + 1].*norm;
    if (b > rounding && std::isfinite(a)) table.levels[i].order = std::log2(a / b);
  }
}

}  // namespace delf
