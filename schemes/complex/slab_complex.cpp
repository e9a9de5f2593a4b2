// SPDX-License-Identifier: MIT
#include "schemes/complex/slab_complex.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <span>

#include "jets/tables/density_on_table.hpp"
#include "lattice/error.hpp"
#include "lattice/space/mesh_space.hpp"

namespace delf {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

void require_densities(const LatticeSystem& system) {
  for (const auto& family : system.families())
    if (!family->made_of() || !family->is_variational() || !family->listed())
      throw BadInput("scheme.method",
                     "scheme.method: on a mesh delf verify checks methods whose action is a density on tables: "
                     "composition, or cgvi with shared end nodes and no constraint; use one of these");
}

/// The points of a table with the numbers of one stencil in their weights.
std::vector<TablePoint> points_of(const StencilFamily& family, int stencil) {
  const auto own = [&](int number) { return family.own_number(number, stencil); };
  std::vector<TablePoint> points = family.made_of()->table.points;
  for (TablePoint& point : points) {
    point.weight *= own(point.own.weight);
    for (std::size_t slot = 0; slot < point.slots.size(); ++slot)
      for (std::size_t e = 0; e < point.own.slots[slot].size(); ++e)
        point.slots[slot][e].weight *= own(point.own.slots[slot][e]);
  }
  return points;
}

}  // namespace

SlabComplex slab_complex(const LatticeSystem& system, const Window& rows) {
  require_densities(system);
  const auto families = system.families();
  const Lattice& lattice = system.lattice();
  const int d = families.front()->made_of()->density->components(), nodes = system.components() / d, N = lattice.sites();
  SlabComplex made{ComplexSystem(d), {}};
  const auto count = static_cast<int>(rows.rows.size());
  std::vector<int> sites(at(count * N * nodes), -1);
  const auto number = [&](int row, int i, int node) -> int& { return sites[at((row * N + i) * nodes + node)]; };
  for (int row = 0; row < count; ++row)
    for (int i = 0; i < N; ++i)
      for (int node = 0; node < (row + 1 < count ? nodes : 1); ++node) {
        const std::int64_t r = rows.first_row + row;
        const double t = system.times()->time(r) + system.component(node * d).at.time * system.times()->step(r);
        const auto& [x, y, z] = lattice.mesh()->mesh.points[at(i)];
        const SiteRole role = lattice.is_fixed(i) || (node == 0 && row == 0) ? SiteRole::given
                              : node == 0 && row + 1 == count               ? SiteRole::final
                                                                            : SiteRole::free;
        number(row, i, node) = made.system.add_site({t, x, y, z}, role);
        for (int a = 0; a < d; ++a) made.values.push_back(rows(r, i, node * d + a));
      }
  std::vector<int> vertices;
  for (const auto& family : families) {
    const std::vector<Site>& pattern = family->pattern().vertices;
    const int placed = made.system.add_family(
        PlacedFamily(family->made_of()->density, static_cast<int>(pattern.size()), points_of(*family, 0)));
    for (int s = 0; s < family->listed()->size(); ++s) {
      const int table = made.system.add_table(placed, points_of(*family, s));
      for (int row = 0; row + 1 < count; ++row) {
        vertices.clear();
        for (const Site& v : pattern)
          vertices.push_back(number(row + v.time, family->listed()->site(s, v.space), v.node));
        const double h = system.times()->step(rows.first_row + row);
        made.system.add_stencil(placed, vertices, table, family->made_of()->table.measure * h, h);
      }
    }
  }
  return made;
}

}  // namespace delf
