// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_convergence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>

#include "lattice/error.hpp"
#include "tools/complex/mesh_evolution.hpp"
#include "tools/complex/static_field.hpp"
#include "tools/report/failure.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/seconds_since.hpp"

namespace delf {
namespace {

struct End {
  std::vector<double> values;
  double time = 0, seconds = 0;
};

/// The last row alone; nothing if the run was interrupted.
std::optional<End> last_row(const ComplexScene& c) {
  End end;
  const auto begin = std::chrono::steady_clock::now();
  if (c.is_one_problem()) {
    StaticField field(c);
    field.solve();
    end.values.assign(field.values().begin(), field.values().end());
  } else {
    const std::unique_ptr<MeshEvolution> evolution = make_mesh_evolution(c);
    evolution->start();
    while (!c.scene.is_over(evolution->newest(), evolution->time()) && !Interrupt::asked()) evolution->step();
    const MeshRow last = evolution->row(evolution->newest());
    end.values.assign(last.values.begin(), last.values.end());
    end.time = evolution->time();
  }
  if (Interrupt::asked()) return std::nullopt;
  end.seconds = seconds_since(begin);
  return end;
}

/// max |a − b| and √(Σ A_i (a − b)²) over the points of a mesh; b may have further points behind them. Sites of a finite
/// complex have the mass 1/sites.
void measure(const ComplexScene& c, const std::vector<double>& a, const std::vector<double>& b, ConvergenceLevel& to) {
  const std::size_t d = c.fields.size();
  double sum = 0;
  to.linf = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    to.linf = std::max(to.linf, std::abs(a[n] - b[n]));
    sum += (c.space ? c.space->masses[n / d] : 1.0 / c.sites()) * (a[n] - b[n]) * (a[n] - b[n]);
  }
  to.l2 = std::sqrt(sum);
}

/// In space and time; of a finite complex the largest that a stencil spans.
std::pair<double, double> steps_of(const ComplexScene& c) {
  if (c.space)
    return {shortest_edge(c.space->mesh), c.is_one_problem() ? ConvergenceLevel::unknown : c.scene.problem.time_step};
  double along_x = 0, along_t = 0;
  for (const StencilList::Entry& e : c.stencils->stencils) {
    const auto positions = c.stencils->positions(e);
    for (const auto& p : positions)
      along_x = std::max(along_x, std::abs(p[1] - positions[0][1])),
      along_t = std::max(along_t, std::abs(p[0] - positions[0][0]));
  }
  return {along_x, along_t};
}

}  // namespace

ConvergenceTable converge(const ComplexScene& scene, int levels) {
  if (scene.stencils && !scene.mesh_file.empty())
    throw scene.scene.settings.error(
        "lattice.mesh",
        "is a finite complex of a file, and has no finer one; give refined:LENGTH,DURATION,NX,NT, or run "
        "files of your own");
  if (scene.stencils && !scene.has_solution())
    throw scene.scene.settings.error(
        "lattice.mesh", "is a finite complex, compared with a solution alone; give exact." + scene.fields.front().name);
  if (!scene.time_steps.empty())
    throw scene.scene.settings.error("lattice.time_steps",
                                     "are not refined; give lattice.courant or lattice.time_step");
  if (scene.step_control() && !(scene.has_solution() && scene.scene.until))
    throw scene.scene.settings.error("lattice.time_steps",
                                     "reversible steps end at times of their own; give run.until, and exact.FIELD to "
                                     "compare with");
  if (!scene.is_one_problem() && scene.scene.steps < 2)
    throw scene.scene.settings.error("run.steps", "must be 2 at least for an order; raise it");
  ConvergenceTable table;
  table.exact = scene.has_solution(), table.all_sites = scene.stencils != nullptr;
  std::unique_ptr<const ComplexScene> coarse;
  std::vector<double> before;
  for (int level = 0; level < levels; ++level) {
    std::unique_ptr<const ComplexScene> now;
    std::optional<End> end;
    try {
      now = std::make_unique<const ComplexScene>(read_complex_scene(scene.scene.settings, level));
      end = last_row(*now);
    } catch (const NumericalFailure& error) {
      if (level == 0) throw;
      table.status = status_of(error), table.ended = error.what();
      break;
    } catch (const Error& error) {  // such as more points than are taken
      if (level == 0) throw;
      table.ended = error.what();
      break;
    }
    if (!end) {
      table.status = "interrupted";
      break;
    }
    ConvergenceLevel line;
    line.sites = now->sites();
    std::tie(line.space_step, line.time_step) = steps_of(*now);
    line.seconds = end->seconds;
    for (const double phi : end->values) line.size = std::max(line.size, std::abs(phi));
    if (table.exact) measure(*now, end->values, now->solution(end->time), line);
    else if (level > 0) measure(*coarse, before, end->values, table.levels.back());
    table.levels.push_back(line);
    before = std::move(end->values), coarse = std::move(now);
  }
  find_orders(table, &ConvergenceLevel::l2);
  return table;
}

}  // namespace delf
