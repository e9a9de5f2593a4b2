// SPDX-License-Identifier: MIT
#include "schemes/complex/slab_complex.hpp"

#include <algorithm>
#include <memory>

#include "lattice/error.hpp"
#include "lattice/space/mesh_space.hpp"

namespace delf {
SlabComplex slab_complex(const LatticeSystem& system, const Window& rows) {
  if (!is_variational(system))
    throw BadInput(
        "scheme.method",
        "scheme.method: on a mesh delf verify checks methods that have an action: composition or cgvi; use one of these");
  const Lattice& lattice = system.lattice();
  const auto& components = system.all_components();
  // With multipliers every value is a site of its own: equations of one point are not matched with its own unknowns.
  const bool by_value = std::ranges::any_of(components, [](const Component& c) { return c.role == Role::multiplier; });
  const int together = by_value ? 1 : system.fields(), nodes = system.components() / together, N = lattice.sites();
  SlabComplex made{ComplexSystem(together), {}};
  const auto count = static_cast<int>(rows.rows.size());
  std::vector<int> sites(count * N * nodes, -1);
  const auto number = [&](int row, int i, int node) -> int& { return sites[(row * N + i) * nodes + node]; };
  for (int row = 0; row < count; ++row)
    for (int i = 0; i < N; ++i)
      for (int node = 0; node < nodes; ++node) {
        const Component& component = components[node * together];
        const bool in_row = component.at.time == 0, last = row + 1 == count;
        if (last && component.role != Role::field) continue;  // of the slab above
        const std::int64_t r = rows.first_row + row;
        const double t = system.times()->time(r) + component.at.time * system.times()->step(r);
        const auto& [x, y, z] = lattice.mesh()->mesh.points[i];
        const SiteRole role = lattice.is_fixed(i) || (in_row && row == 0) ? SiteRole::given
                              : in_row && last                            ? SiteRole::final
                                                                          : SiteRole::free;
        number(row, i, node) = made.system.add_site({t, x, y, z}, role);
        for (int a = 0; a < together; ++a) made.values.push_back(rows(r, i, node * together + a));
      }
  std::vector<int> vertices;
  for (const auto& family : system.families()) {
    const int placed = made.system.add_family(ComplexSystem::Family(family));
    for (int row = 0; row + 1 < count; ++row)
      for (int s = 0; s < system.anchors(*family); ++s) {
        if (!system.has_stencil(*family, rows.first_row + row, s)) continue;
        vertices.clear();
        for (int i = 0; i < family->size(); i += together)
          vertices.push_back(
              number(row + family->site(i).time, family->column(s, i), family->values()[i].component / together));
        made.system.add_stencil(placed, vertices, s, 1, system.times()->step(rows.first_row + row));
      }
  }
  return made;
}

}  // namespace delf
