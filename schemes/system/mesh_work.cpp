// SPDX-License-Identifier: MIT
#include "schemes/system/mesh_work.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "jets/tables/density_on_table.hpp"
#include "lattice/index.hpp"
#include "schemes/families/boundary_flux.hpp"
#include "schemes/families/mesh_families.hpp"

namespace delf {
namespace {

/// The rate of what is given.
class RateInTime final : public GivenInTime {
 public:
  explicit RateInTime(std::shared_ptr<const GivenInTime> of) : of_(std::move(of)) {}
  double value(int field, double t) const override { return of_->rate(field, t); }
  double rate(int, double) const override { return 0; }

 private:
  std::shared_ptr<const GivenInTime> of_;
};

/// The quadrature of a method of collocation, which has no action: the nodes of a slab above its lower row, τ_i, with the weights
/// b_i that are exact for polynomials, Σ_i b_i τ_iᵏ = 1/(k + 1).
StencilTable rule_of_nodes(const StencilTable& time) {
  StencilTable rule{.pattern = time.pattern, .points = {}, .nodes = time.nodes, .measure = time.measure};
  for (std::size_t l = 0; l < time.pattern.vertices.size(); ++l) {
    const Site& vertex = time.pattern.vertices[l];
    const double tau = vertex.time + time.nodes[at(vertex.node)].time;
    if (!(tau > 0)) continue;
    TablePoint point{.weight = 0, .time = tau, .slots = {}};
    point.slots[at(JetSlot::phi)] = {{static_cast<int>(l), 1.0}};
    rule.points.push_back(std::move(point));
  }
  const auto n = static_cast<int>(rule.points.size());
  Eigen::MatrixXd powers(n, n);
  Eigen::VectorXd integrals(n);
  for (int k = 0; k < n; ++k) {
    for (int i = 0; i < n; ++i) powers(k, i) = std::pow(rule.points[at(i)].time, k);
    integrals[k] = 1.0 / (k + 1);
  }
  const Eigen::VectorXd weights = powers.fullPivLu().solve(integrals);
  for (int i = 0; i < n; ++i) rule.points[at(i)].weight = weights[i];
  return rule;
}

/// The table of time that a family of sites is made of, without φ_t.
StencilTable time_without_rates(const LatticeSystem& system) {
  StencilTable time = system.families().front()->made_of()->table;
  if (!is_variational(system)) return rule_of_nodes(time);
  time.lower_side.clear();
  for (auto* points : {&time.points, &time.tests})
    for (TablePoint& point : *points) point.own = {}, point.slots[at(JetSlot::phi_t)].clear();
  return time;
}

}  // namespace

MeshWork::MeshWork(const LatticeSystem& system, std::shared_ptr<const BatchDensity> density)
    : system_(system), space_(*system.lattice().mesh()) {
  std::map<std::int32_t, std::int32_t> numbers;
  const auto number = [&](std::int32_t point) {
    const auto [known, fresh] = numbers.try_emplace(point, static_cast<std::int32_t>(points_.size()));
    if (fresh) points_.push_back(point), patch_.mesh.points.push_back(space_.mesh.points[at(point)]);
    return known->second;
  };
  patch_.mesh.dimension = space_.mesh.dimension;
  std::vector<char> is_driven(space_.mesh.points.size(), 0);
  for (const auto& [point, given] : space_.driven) is_driven[at(point)] = 1, driven_.push_back({number(point), given});
  for (const auto& [point, given] : space_.fluxes) fluxes_.push_back({number(point), given});
  for (int c = 0; c < space_.mesh.cells(); ++c) {
    const auto cell = space_.mesh.cell(c);
    if (std::ranges::none_of(cell, [&](std::int32_t p) { return is_driven[at(p)] != 0; })) continue;
    std::vector<std::int32_t> corners;
    for (std::size_t l = 0; l < cell.size(); ++l) {
      corners.push_back(number(cell[l]));
      if (!space_.mesh.places.empty()) patch_.mesh.places.push_back(space_.mesh.corner(c, l));
    }
    patch_.mesh.add_cell(corners);
  }
  patch_.fixed.assign(points_.size(), 0);
  const StencilTable time = time_without_rates(system);
  const auto sites = static_cast<int>(points_.size());
  if (!driven_.empty()) {
    potential_ = forces(mesh_families(time, density, patch_));
    energy_.emplace(density, patch_);
  }
  std::vector<MeshSpace::AtPoint> rates;
  for (const auto& [point, given] : fluxes_) rates.push_back({point, std::make_shared<RateInTime>(given)});
  if (auto family = boundary_flux(time, density->components(), sites, rates)) flux_rates_ = forces({std::move(family)});
}

std::unique_ptr<const MeshWork::Forces> MeshWork::forces(
    const std::vector<std::shared_ptr<const StencilFamily>>& families) const {
  LatticeSystem system(Lattice::on(std::make_shared<MeshSpace>(patch_)), families, system_.time_step(),
                       system_.all_components());
  system.share_times(system_);
  return std::make_unique<const Forces>(std::move(system));
}

template <class Weight>
double MeshWork::slab(const Forces& forces, const Window& rows, const Weight& weight) const {
  const int C = system_.components();
  const std::int64_t lower = rows.first_row;
  const RowTimes& times = *system_.times();
  const std::vector<double> above = forces.above(rows, lower), below = forces.below(rows, lower + 1);
  double sum = 0;
  for (int c = 0; c < C; ++c) {
    const Component& component = system_.component(c);
    if (component.role == Role::multiplier) continue;
    const double t = times.time(lower) + component.at.time * times.step(lower);
    for (int i = 0; i < static_cast<int>(points_.size()); ++i)
      if (const double force = -above[at(i * C + c)]; force != 0)
        sum += force * weight(i, component.field, t, rows(lower, i, c));
    if (component.role != Role::field) continue;
    for (int i = 0; i < static_cast<int>(points_.size()); ++i)
      if (const double force = below[at(i * C + c)]; force != 0)
        sum += force * weight(i, component.field, times.time(lower + 1), rows(lower + 1, i, c));
  }
  return sum;
}

std::vector<double> MeshWork::on_patch(std::span<const double> row) const {
  const std::size_t C = at(system_.components());
  std::vector<double> values;
  for (const auto point : points_) {
    const auto first = row.begin() + static_cast<std::ptrdiff_t>(at(point) * C);
    values.insert(values.end(), first, first + static_cast<std::ptrdiff_t>(C));
  }
  return values;
}

double MeshWork::terms(std::span<const double> row, double t) const {
  const std::size_t C = at(system_.components()), d = at(system_.fields()), points = points_.size();
  double sum = 0;
  const auto value = [&](std::int32_t point, std::size_t a) {
    return row[at(point) * C + at(system_.field_component(static_cast<int>(a)))];
  };
  if (energy_) {
    std::vector<double> y(points * d), rates(points * d, 0.0);
    for (std::size_t i = 0; i < points; ++i)
      for (std::size_t a = 0; a < d; ++a) y[i * d + a] = value(static_cast<std::int32_t>(i), a);
    sum -= (*energy_)(y, rates, t);
    for (const auto& [point, given] : driven_)
      for (std::size_t a = 0; a < d; ++a) rates[at(point) * d + a] = given->rate(static_cast<int>(a), t);
    sum += (*energy_)(y, rates, t);
  }
  for (const auto& [point, given] : fluxes_)
    for (std::size_t a = 0; a < d; ++a) sum += given->value(static_cast<int>(a), t) * value(point, a);
  return sum;
}

void MeshWork::add(const Window& rows) {
  const RowTimes& times = *system_.times();
  const std::int64_t lower = rows.last_row() - 1;
  const std::vector<double> first = on_patch(rows.rows[rows.rows.size() - 2]), last = on_patch(rows.rows.back());
  if (!begun_) first_ = terms(first, times.time(lower)), begun_ = true;
  const auto of = [&](const Forces& forces) { return forces.system.window(lower, {first, last}, 0); };
  if (potential_) {
    std::vector<const GivenInTime*> driven(points_.size(), nullptr);
    for (const auto& [point, given] : driven_) driven[at(point)] = given.get();
    integral_ -= slab(*potential_, of(*potential_),
                      [&](int i, int a, double t, double) { return driven[at(i)] ? driven[at(i)]->rate(a, t) : 0; });
  }
  if (flux_rates_) integral_ -= slab(*flux_rates_, of(*flux_rates_), [](int, int, double, double phi) { return phi; });
  before_ = std::exchange(sum_, integral_ + terms(last, times.time(lower + 1)) - first_);
}

void MeshWork::give_rates(std::span<double> rates, double t) const {
  const std::size_t d = at(system_.fields());
  for (const auto& [point, given] : space_.driven)
    for (std::size_t a = 0; a < d; ++a) rates[at(point) * d + a] = given->rate(static_cast<int>(a), t);
}

}  // namespace delf
