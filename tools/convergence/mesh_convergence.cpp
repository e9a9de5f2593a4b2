// SPDX-License-Identifier: MIT
#include "tools/convergence/mesh_convergence.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>

#include "tools/complex/mesh_stepping.hpp"
#include "tools/complex/mesh_summary.hpp"
#include "tools/complex/static_field.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/seconds_since.hpp"

namespace delf {
namespace {

struct End {
  std::vector<double> values;
  double time = 0;
};

/// The last row alone.
End end_of(const ComplexScene& c) {
  if (c.is_one_problem()) {
    StaticField field(c);
    field.solve();
    return {{field.values().begin(), field.values().end()}};
  }
  Outcome unread;
  MeshStepping stepping(c, unread);
  const MeshRow last = stepping.last_row();
  return {{last.values.begin(), last.values.end()}, last.time};
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
  if (!scene.scene.problem.time_steps.empty())
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
  fill(table, levels, &ConvergenceLevel::l2, [&](int level) {
    auto now = std::make_unique<const ComplexScene>(read_complex_scene(scene.scene.settings, level));
    const auto begin = std::chrono::steady_clock::now();
    End end = end_of(*now);
    if (Interrupt::asked()) return false;
    ConvergenceLevel line;
    line.sites = now->sites();
    std::tie(line.space_step, line.time_step) = steps_of(*now);
    line.seconds = seconds_since(begin);
    for (const double phi : end.values) line.size = std::max(line.size, std::abs(phi));
    const auto put = [](const FieldError& error, ConvergenceLevel& to) { to.linf = error.linf, to.l2 = error.l2; };
    if (table.exact) put(error_on(*now, end.values, now->solution(end.time)), line);
    else if (level > 0) put(error_on(*coarse, before, end.values), table.levels.back());
    table.levels.push_back(line);
    before = std::move(end.values), coarse = std::move(now);
    return true;
  });
  return table;
}

}  // namespace delf
