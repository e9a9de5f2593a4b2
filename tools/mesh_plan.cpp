// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "schemes/methods/mesh_rows.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stability/mesh_frequency.hpp"
#include "schemes/stepping/evolution.hpp"
#include "tools/complex/mesh_summary.hpp"
#include "tools/complex/static_field.hpp"
#include "tools/plan.hpp"

namespace delf {
namespace {

/// Blocks of a level do not depend on each other.
std::string levels_in_words(const ComplexPlan& plan) {
  if (plan.levels == 0) return "none";
  return fmt::format("{:.4g} blocks a level, {} in the widest", static_cast<double>(plan.blocks()) / plan.levels,
                     plan.widest);
}

void say_memory(std::size_t bytes, std::size_t rows) {
  fmt::print("  memory     {} bytes: rows of the field {} B, stencils and matrices {} B\n", bytes, rows, bytes - rows);
}

/// Of a finite complex.
void plan_sites(const ComplexScene& c) {
  const StaticField field(c);
  fmt::print("{}: {}, {} sites, {}\n", c.scene.name, c.scene.problem.theory, c.sites(), c.mesh_in_words());
  fmt::print("  state      {}\n", c.state_in_words());
  const ComplexPlan& plan = field.solver().plan();
  fmt::print("  stencils   {} in {} families: of one shape, and coupled alike\n", c.cells(), field.system().families());
  if (const std::string shape = c.topology_in_words(); !shape.empty())
    fmt::print("  cells      {}, area {:.6g}\n", shape, c.tiling.area);
  fmt::print("  solve      {}\n", plan.describe());
  fmt::print("             level by level, each by {}\n", !field.solver().is_direct()
                                                              ? "Newton steps with a sparse matrix and a line search"
                                                          : plan.largest == 1 ? "divisions: explicit"
                                                                              : "one sparse factorisation");
  fmt::print("  levels     {}\n", levels_in_words(plan));
  if (const std::string threads = threads_in_words(field.solver(), c.scene.problem.threads); !threads.empty())
    fmt::print("  threads    {}\n", threads);
  say_memory(field.bytes(), 8 * field.values().size());
  for (const std::string& gap : c.tiling.gaps) fmt::print("  warning    {}\n", gap);
  fmt::print(
      "  left out   symbol, lattice norms: not applicable to a finite complex; energies, unless its sites lie in "
      "rows\n");
}

void plan_mesh(const ComplexScene& c) {
  const CellSpace& space = *c.space;
  const std::size_t walls = boundary_points(space.mesh).size(), held = std::ranges::count(space.fixed, 1);
  fmt::print("{}: {}, {} points, {}\n", c.scene.name, c.scene.problem.theory, space.sites(), c.mesh_in_words());
  fmt::print("  state      {}\n", c.state_in_words());
  fmt::print("  mesh       {} {:.6g}, shortest edge {:.6g}, {} boundary points{}\n",
             space.mesh.dimension == 1 ? "length" : "area", area_of(space), shortest_edge(space.mesh), walls,
             walls == 0     ? ""
             : held == 0    ? ", natural"
             : held < walls ? fmt::format(", {} fixed, {} natural", held, walls - held)
                            : ", fixed");
  if (!space.driven.empty()) fmt::print("             {} points are driven\n", space.driven.size());
  if (!space.fluxes.empty()) fmt::print("             something flows in at {} points\n", space.fluxes.size());
  fmt::print("             {}\n", c.topology_in_words());
  const std::size_t values = 8 * space.fields_of_row();
  if (c.time == MeshTime::none) {
    const StaticField field(c);
    fmt::print("  stencils   {} of sites and cells\n  solve      {}: sparse Newton steps with a line search\n",
               field.system().complex().stencils(), field.solver().plan().describe());
    say_memory(field.bytes(), values);
  } else if (c.time == MeshTime::cells) {
    const std::vector<double> steps = cell_steps(space.mesh, c.scene.problem.cell_courant);
    const auto [least, largest] = std::ranges::minmax(steps);
    double updates = 0;
    for (const double h : steps) updates += static_cast<double>(c.scene.steps) * c.scene.problem.time_step / h;
    fmt::print(
        "  steps      each cell by its own, {:.6g} to {:.6g}: {:.6g} updates, and {:.6g} with the least for all\n",
        least, largest, updates, static_cast<double>(c.scene.steps) * static_cast<double>(steps.size()));
    fmt::print("  solve      explicit, in the order of a priority queue\n");
    say_memory(Simulation(c.problem_on_mesh()).bytes(), 2 * values);
  } else {
    const Problem& p = c.scene.problem;
    const Simulation simulation(c.problem_on_mesh());
    fmt::print("  steps      {} of {}\n", c.scene.steps,
               p.step_control
                   ? fmt::format("h = {:.6g}/sqrt(1 + {:.6g}^2 <phi_t^2>), reversible; about so many, or more",
                                 p.time_step, *p.step_control)
               : p.time_steps.empty() ? fmt::format("h = {:.6g}", p.time_step)
                                      : fmt::format("{} lengths in turn", p.time_steps.size()));
    if (const auto most = c.has_method() ? std::nullopt : longest_step(simulation.evolution().system()))
      fmt::print("  stable     h below {:.6g}, by linear theory about 0\n", *most);
    fmt::print("{}", simulation.plan_report());
  }
  fmt::print(
      "  left out   symbol, strips, lattice norms: not applicable to a mesh; errors are sums over sites with their "
      "masses\n");
}

}  // namespace

ExitCode plan(const ComplexScene& c, bool latex) {
  if (latex) throw BadScene("command line: --latex: is for lattices, and this scene is on a mesh; leave it out");
  try {
    c.stencils ? plan_sites(c) : plan_mesh(c);
  } catch (const BadInput& bad) {
    throw c.scene.settings.located(bad);
  }
  return ExitCode::done;
}

}  // namespace delf
