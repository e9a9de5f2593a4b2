// SPDX-License-Identifier: MIT
#include "tools/verify/checked_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "jets/tables/space_table.hpp"
#include "lattice/index.hpp"
#include "schemes/complex/complex_region.hpp"
#include "schemes/families/mesh_families.hpp"
#include "schemes/methods/mesh_rows.hpp"
#include "schemes/theories/theory_on_space.hpp"

namespace delf {
namespace {

/// The times of the nodes of a cell of time, as fractions of the step.
std::vector<double> times_of_nodes(const LatticeSystem& system) {
  std::vector<double> times(1, 0.0);
  for (const auto& family : system.families())
    for (int i = 0; i < family->size(); ++i) {
      const std::size_t node = at(family->site(i).node);
      times.resize(std::max(times.size(), node + 1));
      if (node > 0) times[node] = system.component(family->values()[i].component).at.time;
    }
  return times;
}

}  // namespace

CheckedRows checked(const ComplexSystem& system, std::vector<double> y) {
  const LatticeSystem& row = system.row();
  return {std::make_shared<const RegionSystem>(row, region_of(system)), row.window(0, {std::move(y)}, 0),
          [&system](Site site) { return system.complex().name(site.space); }};
}

CheckedRows WindowsOnMesh::operator()(Window rows) {
  const int N = system_.lattice().sites(), count = static_cast<int>(rows.rows.size());
  const std::vector<double> nodes = times_of_nodes(system_);
  if (rows_ != rows.rows.size()) {
    std::vector<Site> sites;
    for (int row = 0; row < count; ++row)
      for (int i = 0; i < N; ++i)
        for (int node = 0; node < std::ssize(nodes); ++node)
          if (node == 0 || row + 1 < count) sites.push_back({row, i, node});  // of the last row: in the slab above
    Region whole = Region::from_sites(stencils_of(system_), std::move(sites), [lattice = system_.lattice()](Site site) {
      return lattice.is_fixed(site.space);
    });
    everywhere_ = std::make_shared<RegionSystem>(system_, std::move(whole));
    rows_ = rows.rows.size();
  }
  everywhere_->move_to(rows.first_row);
  const auto name = [this, N, nodes, first = rows.first_row](Site site) {
    const auto number = (site.time * N + site.space) * std::ssize(nodes) + site.node;
    const std::int64_t row = first + site.time;
    const double t = system_.times()->time(row) + nodes[at(site.node)] * system_.times()->step(row);
    const auto& [x, y, z] = system_.lattice().mesh()->mesh.points[at(site.space)];
    return fmt::format("site {} at (t, x, y, z) = ({:.6g}, {:.6g}, {:.6g}, {:.6g})", number, t, x, y, z);
  };
  return {everywhere_, std::move(rows), name};
}

LatticeSystem system_of_rows(const ComplexScene& scene) {
  const Problem problem = scene.problem_on_mesh();
  SchemeParts parts = rows_on_mesh(*scene.theory, problem);
  return {problem.lattice, std::move(parts.families), problem.time_step, std::move(parts.components)};
}

LatticeSystem system_of_field(const ComplexScene& scene) {
  auto all = mesh_families(point_space(), scene.space->density, *scene.space);
  std::vector<Component> components = fields(scene.space->fields());
  if (scene.space->constraint) {
    all.push_back(scene.space->constraint);
    std::ranges::copy(multipliers_of(*scene.theory), std::back_inserter(components));
  }
  return {Lattice::on(scene.space), std::move(all), 1, std::move(components)};
}

std::vector<double> row_of(const LatticeSystem& system, std::span<const double> fields,
                           std::span<const double> multipliers) {
  const std::size_t d = at(system.fields());
  std::vector<double> row;
  auto multiplier = multipliers.begin();
  for (std::size_t i = 0; i < at(system.lattice().sites()); ++i)
    for (const Component& c : system.all_components())
      row.push_back(c.role == Role::field ? fields[i * d + at(c.field)] : multipliers.empty() ? 0 : *multiplier++);
  return row;
}

std::vector<double> fields_of(const LatticeSystem& system, std::span<const double> row) {
  const std::size_t C = at(system.components());
  std::vector<double> fields;
  for (std::size_t n = 0; n < row.size(); ++n)
    if (system.component(static_cast<int>(n % C)).role == Role::field) fields.push_back(row[n]);
  return fields;
}

}  // namespace delf
