// SPDX-License-Identifier: MIT
#include "schemes/complex/cell_space.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/families/boundary_flux.hpp"
#include "schemes/system/constraint_slopes.hpp"

namespace delf {
namespace {

/// The number 1 of a field, and 0 of the others.
class UnitFlux final : public GivenInTime {
 public:
  explicit UnitFlux(int field) : field_(field) {}
  double value(int field, double) const override { return field == field_ ? 1 : 0; }
  double rate(int, double) const override { return 0; }

 private:
  int field_;
};

ComplexSystem::Family flux_of(int field, int fields) {
  TablePoint point;
  point.set(JetSlot::phi, {1});
  ComplexSystem::Family family(
      std::make_shared<FluxDensity>(std::vector<std::shared_ptr<const GivenInTime>>{std::make_shared<UnitFlux>(field)},
                                    fields),
      1, {point});
  family.add_table(std::vector{point});
  return family;
}

}  // namespace

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

PotentialRows::PotentialRows(const CellSpace& space, ComplexSystem& system, bool weights)
    : space_(space),
      system_(system),
      weights_(weights),
      per_point_(space.constraint ? space.fields() : 1),
      per_row_(space.sites() * (per_point_ + space.constraints())),
      site_(system.add_family(space.tables.site())) {
  std::map<int, int> families;  // by the number of corners
  for (int c = 0; c < space.mesh.cells(); ++c) {
    const auto corners = static_cast<int>(space.mesh.cell(c).size());
    if (!families.contains(corners)) families[corners] = system.add_family(space.tables.gradient(corners));
    gradient_.push_back(families[corners]);
    gradient_tables_.push_back(system.add_table(families[corners], space.tables.gradient_table(space.mesh, c)));
  }
  for (int a = 0; a < space.fields() && !space.fluxes.empty(); ++a)
    flux_.push_back(system.add_family(flux_of(a, space.fields())));
  if (space.constraint) constraint_ = system.add_family(ComplexSystem::Family(space.constraint));
}

void PotentialRows::append_sites(int row, std::span<const std::int32_t> points, std::vector<int>& sites) const {
  for (const auto p : points)
    for (int a = 0; a < per_point_; ++a) sites.push_back(row * per_row_ + p * per_point_ + a);
}

int PotentialRows::point_of(int site) const {
  const int fields = space_.sites() * per_point_;
  return site < fields ? site / per_point_ : (site - fields) / space_.constraints();
}

void PotentialRows::add(double t, double measure) {
  const int n = space_.sites(), row = rows_++;
  for (int s = 0; s < per_row_; ++s) {
    const int i = point_of(s);
    const Mesh::Point& p = space_.mesh.points[i];
    system_.add_site({t, p[0], p[1], p[2]}, space_.fixed[i] ? SiteRole::given : SiteRole::free);
  }
  std::vector<int> sites;
  const auto of = [&](std::span<const std::int32_t> points) -> std::vector<int>& {
    sites.clear();
    append_sites(row, points, sites);
    return sites;
  };
  for (std::int32_t i = 0; i < n; ++i) system_.add_stencil(site_, of({&i, 1}), 0, space_.masses[i] * measure);
  for (int c = 0; c < space_.mesh.cells(); ++c)
    system_.add_stencil(gradient_[c], of(space_.mesh.cell(c)), gradient_tables_[c], measure);
  for (const auto& [point, flux] : space_.fluxes)
    for (int a = 0; a < space_.fields(); ++a)
      system_.add_stencil(flux_[a], of({&point, 1}), 0, flux->value(a, t) * measure);
  for (std::int32_t i = 0; i < n && space_.constraint; ++i) {
    if (space_.fixed[i]) continue;
    of({&i, 1});
    const int m = space_.constraints();
    for (int b = 0; b < m; ++b) sites.push_back(row * per_row_ + n * per_point_ + i * m + b);
    system_.add_stencil(constraint_, sites, 0, (weights_ ? space_.masses[i] : 1) * measure);
  }
}

ComplexSystem mesh_complex(const CellSpace& space) {
  ComplexSystem system = PotentialRows::make_complex(space);
  PotentialRows(space, system, false).add(0, 1);
  return system;
}

}  // namespace delf
