// SPDX-License-Identifier: MIT
#include "schemes/complex/space_rows.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
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

SpaceRows::SpaceRows(const CellSpace& space)
    : space_(space),
      per_point_(space.constraint ? space.fields() : 1),
      per_row_(space.sites() * (per_point_ + space.constraints())),
      is_still_(true),
      system_(space.constraint ? 1 : space.fields()) {
  add_row(0, 1);
}

SpaceRows::SpaceRows(const CellSpace& space, std::span<const double> times)
    : space_(space),
      per_point_(space.constraint ? space.fields() : 1),
      per_row_(space.sites() * (per_point_ + space.constraints())),
      system_(space.constraint ? 1 : space.fields()) {
  const int n = space.sites();
  // in each row stencils of sites, of cells and of a constraint, and of motion to the next row
  const std::size_t rows = times.size(), sites = at(n), cells = at(space.mesh.cells()), values = at(per_point_),
                    constraints = space.constraint ? sites : 0;
  system_.reserve(
      rows * at(per_row_), rows * (sites + cells + constraints) + (rows - 1) * sites,
      rows * (values * (sites + space.mesh.vertices.size()) + (values + at(space.constraints())) * constraints) +
          2 * (rows - 1) * values * sites);
  for (std::size_t j = 0; j < times.size(); ++j) {
    const double below = j == 0 ? 0 : times[j] - times[j - 1],
                 above = j + 1 == times.size() ? 0 : times[j + 1] - times[j];
    add_row(times[j], 0.5 * (below + above));
    if (j == 0) continue;
    if (j == 1) motion_ = system_.add_family(space.tables.motion());
    for (std::int32_t i = 0; i < n; ++i)
      system_.add_stencil(motion_, sites_of({rows_ - 2, rows_ - 1}, {&i, 1}), 0, space.masses[i] * below, below);
  }
  const int fields = n * per_point_, last = rows_ - 1;
  for (int j = 0; j < rows_; ++j)
    for (int s = 0; s < per_row_; ++s) {
      const bool multiplier = s >= fields;
      if (space.fixed[point_of(s)]) continue;
      // λ of the last row is in no equation, and G there is one for its fields; G of row 1 is in the data.
      system_.set_role(j * per_row_ + s, j == 0      ? SiteRole::given
                                         : j == last ? multiplier ? SiteRole::initial : SiteRole::final
                                         : j == 1    ? multiplier ? SiteRole::final : SiteRole::initial
                                                     : SiteRole::free);
    }
}

std::span<const int> SpaceRows::sites_of(std::initializer_list<int> rows, std::span<const std::int32_t> points) {
  sites_.clear();
  for (const int row : rows)
    for (const auto p : points)
      for (int a = 0; a < per_point_; ++a) sites_.push_back(row * per_row_ + p * per_point_ + a);
  return sites_;
}

int SpaceRows::point_of(int s) const {
  const int fields = space_.sites() * per_point_;
  return s < fields ? s / per_point_ : (s - fields) / space_.constraints();
}

void SpaceRows::add_row(double t, double measure) {
  const int n = space_.sites(), row = rows_;
  for (int s = 0; s < per_row_; ++s) {
    const int i = point_of(s);
    const Mesh::Point& p = space_.mesh.points[i];
    system_.add_site({t, p[0], p[1], p[2]}, space_.fixed[i] ? SiteRole::given : SiteRole::free);
  }
  if (rows_++ == 0) {
    site_ = system_.add_family(space_.tables.site());
    std::map<int, int> families;
    for (int c = 0; c < space_.mesh.cells(); ++c) {
      const auto corners = static_cast<int>(space_.mesh.cell(c).size());
      if (!families.contains(corners)) families[corners] = system_.add_family(space_.tables.gradient(corners));
      gradient_.push_back(families[corners]);
      gradient_tables_.push_back(system_.add_table(families[corners], space_.tables.gradient_table(space_.mesh, c)));
    }
    for (int a = 0; a < space_.fields() && !space_.fluxes.empty(); ++a)
      flux_.push_back(system_.add_family(flux_of(a, space_.fields())));
    if (space_.constraint) {
      constraint_ = system_.add_family(ComplexSystem::Family(space_.constraint));
    }
  }
  measures_.push_back(measure);
  for (std::int32_t i = 0; i < n; ++i)
    system_.add_stencil(site_, sites_of({row}, {&i, 1}), 0, space_.masses[i] * measure);
  for (int c = 0; c < space_.mesh.cells(); ++c)
    system_.add_stencil(gradient_[c], sites_of({row}, space_.mesh.cell(c)), gradient_tables_[c], measure);
  for (const auto& [point, flux] : space_.fluxes)
    for (int a = 0; a < space_.fields(); ++a)
      system_.add_stencil(flux_[a], sites_of({row}, {&point, 1}), 0, flux->value(a, t) * measure);
  for (std::int32_t i = 0; i < n && space_.constraint; ++i) {
    if (space_.fixed[i]) continue;
    sites_of({row}, {&i, 1});
    const int m = space_.constraints();
    for (int b = 0; b < m; ++b) sites_.push_back(row * per_row_ + n * per_point_ + i * m + b);
    system_.add_stencil(constraint_, sites_, 0, weight_of_constraint(i) * measure);
  }
}

double SpaceRows::weight_of_constraint(int point) const { return is_still_ ? 1 : space_.masses[point]; }

std::vector<double> SpaceRows::with_multipliers(std::span<const double> fields,
                                                std::span<const double> multipliers) const {
  const std::size_t of_fields = space_.fields_of_row(), of_multipliers = space_.multipliers_of_row();
  std::vector<double> y(system_.nodes(), 0.0);
  for (int j = 0; j < rows_; ++j) {
    std::ranges::copy(fields.subspan(at(j) * of_fields, of_fields), y.begin() + j * per_row_);
    std::ranges::copy(multipliers.subspan(at(j) * of_multipliers, of_multipliers),
                      y.begin() + j * per_row_ + static_cast<std::ptrdiff_t>(of_fields));
  }
  return y;
}

std::vector<double> SpaceRows::with_multipliers(std::span<const double> fields) const {
  if (!space_.constraint) return {fields.begin(), fields.end()};
  const std::size_t of_fields = space_.fields_of_row(), of_row = space_.values_of_row(), d = at(space_.fields()),
                    m = at(space_.constraints());
  std::vector<double> y = with_multipliers(fields, std::vector<double>(at(rows_) * space_.multipliers_of_row(), 0.0));
  const std::vector<Balance> E = system_.residual(y);
  ConstraintSlopes G(*space_.constraint, d);
  Eigen::MatrixXd slopes(m, d);
  Eigen::VectorXd force(d);
  for (int j = 0; j < rows_; ++j)
    for (std::size_t i = 0; i < space_.mesh.points.size(); ++i) {
      const std::size_t row = at(j) * of_row;
      if (!system_.complex().has_equation(static_cast<int>(row + i * d))) continue;
      for (std::size_t b = 0; b < m; ++b) {
        G.at(b, fields.subspan(at(j) * of_fields + i * d, d));
        for (std::size_t a = 0; a < d; ++a) slopes(static_cast<int>(b), static_cast<int>(a)) = G.slopes()[a];
      }
      for (std::size_t a = 0; a < d; ++a) force[static_cast<int>(a)] = E[row + i * d + a].sum;
      // E + |Δ| Σ λ_b ∂G_b/∂φ = 0 along every ∂G/∂φ
      const double measure = weight_of_constraint(static_cast<int>(i)) * measures_[at(j)];
      const Eigen::VectorXd lambda =
          (slopes * slopes.transpose()).fullPivLu().solve(Eigen::VectorXd(slopes * force)) / -measure;
      for (std::size_t b = 0; b < m; ++b) y[row + of_fields + i * m + b] = lambda[static_cast<int>(b)];
    }
  return y;
}

}  // namespace delf
