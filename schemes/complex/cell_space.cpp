// SPDX-License-Identifier: MIT
#include "schemes/complex/cell_space.hpp"

#include <algorithm>
#include <cmath>

#include "jets/tables/space_table.hpp"
#include "lattice/index.hpp"
#include "schemes/families/mesh_families.hpp"
#include "schemes/system/constraint_slopes.hpp"

namespace delf {

CellSpace::CellSpace(Mesh mesh_, std::shared_ptr<const BatchDensity> density_, bool fixed_boundary,
                     std::shared_ptr<const StencilFamily> constraint_)
    : MeshSpace{std::move(mesh_), {}},
      density(std::move(density_)),
      constraint(std::move(constraint_)),
      tables(density),
      masses(lumped_masses(mesh)) {
  fixed = held_points(mesh, fixed_boundary);
}

void CellSpace::each_constraint(std::span<const double> values, const UseConstraint& use) const {
  const std::size_t d = fields();
  ConstraintSlopes G(*constraint, d);
  for (std::size_t i = 0; i * d < values.size(); ++i)
    for (std::size_t b = 0; b < G.constraints(); ++b) {
      const double value = G.at(b, values.subspan(i * d, d));
      use(i, value, G.slopes());
    }
}

double CellSpace::largest_constraint(std::span<const double> values) const {
  double most = 0;
  each_constraint(values, [&](std::size_t, double G, std::span<const double>) {
    if (!(std::abs(G) <= most)) most = std::abs(G);
  });
  return most;
}

ComplexSystem mesh_complex(const CellSpace& space) {
  const int n = space.sites(), m = space.constraints(), per_point = m > 0 ? space.fields() : 1;
  ComplexSystem system(m > 0 ? 1 : space.fields());
  for (const int count : {per_point, m})
    for (std::size_t i = 0; i < at(n); ++i)
      for (int a = 0; a < count; ++a) {
        const Mesh::Point& p = space.mesh.points[i];
        system.add_site({0, p[0], p[1], p[2]}, space.fixed[i] ? SiteRole::given : SiteRole::free);
      }
  std::vector<int> sites;
  const auto append = [&](int point) {
    for (int a = 0; a < per_point; ++a) sites.push_back(point * per_point + a);
  };
  for (const auto& family : mesh_families(point_space(), space.density, space)) {
    const int number = system.add_family(ComplexSystem::Family(family));
    const ListedStencils& listed = *family->listed();
    for (int s = 0; s < listed.size(); ++s) {
      sites.clear();
      for (int l = 0; l < family->pattern().size(); ++l) append(listed.site(s, l));
      system.add_stencil(number, sites, s, 1);
    }
  }
  if (!space.constraint) return system;
  const int number = system.add_family(ComplexSystem::Family(space.constraint));
  for (int i = 0; i < n; ++i) {
    if (space.fixed[at(i)]) continue;
    sites.clear();
    append(i);
    for (int b = 0; b < m; ++b) sites.push_back(n * per_point + i * m + b);
    system.add_stencil(number, sites, 0, 1);
  }
  return system;
}

}  // namespace delf
