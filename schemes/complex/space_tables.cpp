// SPDX-License-Identifier: MIT
#include "schemes/complex/space_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "lattice/error.hpp"

namespace delf {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }
using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector scaled(const Vector& a, double s) { return {s * a[0], s * a[1], s * a[2]}; }
Vector unit(const Vector& a) { return scaled(a, 1 / std::sqrt(dot(a, a))); }

/// A quadrature point of a cell: its share of the measure, N_l, and ∂_aN_l in an orthonormal frame of the tangent space.
struct CellPoint {
  double weight;
  std::vector<double> value;
  std::vector<std::vector<double>> slopes;  ///< [a][l]
};

/// From N_l and its derivatives by the cell's own coordinates ξ, η. With tangents g_ξ = Σ x_l ∂_ξN_l and g_η:
/// e₁ = g_ξ/|g_ξ|, e₂ ⟂ e₁; ∂_aN = Σ_b (G⁻¹)_ba ∂_bN, G_ba = g_b·e_a.
CellPoint placed(const Mesh& mesh, std::span<const std::int32_t> corners, double weight, std::vector<double> value,
                 const std::vector<std::vector<double>>& by_own) {
  std::vector<Vector> g(by_own.size(), Vector{});
  for (std::size_t b = 0; b < g.size(); ++b)
    for (std::size_t l = 0; l < corners.size(); ++l)
      for (std::size_t k = 0; k < 3; ++k)
        g[b][k] += by_own[b][l] * mesh.points[static_cast<std::size_t>(corners[l])][k];
  const Vector e1 = unit(g[0]);
  const double g11 = dot(g[0], e1);
  CellPoint point{weight * g11, std::move(value), {}};
  std::vector<double> first(corners.size()), second(corners.size());
  if (g.size() == 1) {
    for (std::size_t l = 0; l < first.size(); ++l) first[l] = by_own[0][l] / g11;
    point.slopes = {first};
    return point;
  }
  const double g21 = dot(g[1], e1);
  Vector normal = g[1];
  for (std::size_t k = 0; k < 3; ++k) normal[k] -= g21 * e1[k];
  const double g22 = std::sqrt(dot(normal, normal));
  point.weight *= g22;
  for (std::size_t l = 0; l < first.size(); ++l) {
    first[l] = by_own[0][l] / g11;
    second[l] = (by_own[1][l] - g21 * first[l]) / g22;
  }
  point.slopes = {first, second};
  return point;
}

std::vector<CellPoint> cell_points(const Mesh& mesh, int cell) {
  const auto corners = mesh.cell(cell);
  if (corners.size() == 2) return {placed(mesh, corners, 1, {0.5, 0.5}, {{-1, 1}})};
  if (corners.size() == 3) return {placed(mesh, corners, 0.5, {1. / 3, 1. / 3, 1. / 3}, {{-1, 1, 0}, {-1, 0, 1}})};
  std::vector<CellPoint> points;  // Gauss, 2 × 2 points of the unit square
  const double a = 0.5 - std::sqrt(3.0) / 6;
  for (const double u : {a, 1 - a})
    for (const double v : {a, 1 - a})
      points.push_back(placed(mesh, corners, 0.25, {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v},
                              {{-(1 - v), 1 - v, v, -v}, {-(1 - u), -u, u, 1 - u}}));
  return points;
}

/// Whether ℓ(φ, 0, p) − ℓ(φ, 0, 0) is multiplied by s² as p is by s, at random jets.
bool is_quadratic(const BatchDensity& density) {
  const int d = density.components(), v = density.variables();
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0.1, 0.7);
  std::vector<std::array<double, 8>> jets(at(v));
  const std::array<double, 4> factors{0, 1, 2, -1};
  for (int i = 0; i < v; ++i) {
    const double value = uniform(random);
    for (std::size_t s = 0; s < 8; ++s)
      jets[at(i)][s] = i < d ? value : i >= 2 * d && i < 3 * d ? value * factors[s % 4] : 0;
  }
  alignas(64) std::array<double, 8> l{};
  std::vector<const double*> slots;
  // packs are aligned
  std::vector<Pack> aligned(at(v + 1) * 8 / lanes);
  for (int i = 0; i < v; ++i) {
    double* const row = reinterpret_cast<double*>(aligned.data()) + 8 * i;
    for (std::size_t s = 0; s < 8; ++s) row[s] = jets[at(i)][s];
    slots.push_back(row);
  }
  double* const x = reinterpret_cast<double*>(aligned.data()) + 8 * v;
  std::fill_n(x, 8, uniform(random));
  density.value({8, slots.data(), uniform(random), x}, l.data());
  const double one = l[1] - l[0], size = std::abs(one) + std::abs(l[0]) + 1e-300;
  return std::abs(l[2] - l[0] - 4 * one) < 1e-12 * size && std::abs(l[3] - l[0] - one) < 1e-12 * size;
}

}  // namespace

SpaceTables::SpaceTables(std::shared_ptr<const BatchDensity> density) : density_(std::move(density)), coupled_(false) {
  const auto refuse = [](const std::string& why) {
    throw BadInput("theory.name",
                   "theory.name: lattice.space = complex needs a density T(phi_t) + V(phi, grad phi), "
                   "quadratic in the gradient; this one " +
                       why + "; choose lattice.space = circle");
  };
  const int d = density_->components();
  if (density_->slots() > 3) refuse("has second derivatives");
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b) {
      if (!density_->is_zero(d + a, b) || !density_->is_zero(d + a, 2 * d + b))
        refuse("couples phi_t with phi or phi_x");
      coupled_ = coupled_ || !density_->is_zero(2 * d + a, b);
    }
  if (!is_quadratic(*density_)) refuse("is not quadratic in phi_x");
}

std::vector<TablePoint> SpaceTables::motion_table() const {
  TablePoint point;
  point.set(JetSlot::phi_t, {-1, 1});
  return {point};
}

std::vector<TablePoint> SpaceTables::site_table() const {
  TablePoint point;
  point.set(JetSlot::phi, {1});
  return {point};
}

std::vector<TablePoint> SpaceTables::gradient_table(const Mesh& mesh, int cell) const {
  std::vector<TablePoint> points;
  for (const CellPoint& q : cell_points(mesh, cell))
    for (const std::vector<double>& slope : q.slopes) {
      TablePoint point{.weight = q.weight, .slots = {}};
      // Every corner has an entry, so that all tables have one form.
      for (std::size_t l = 0; l < slope.size(); ++l) {
        point.slots[at(static_cast<int>(JetSlot::phi_x))].push_back({static_cast<int>(l), slope[l]});
        if (coupled_) point.slots[at(static_cast<int>(JetSlot::phi))].push_back({static_cast<int>(l), q.value[l]});
      }
      points.push_back(point);
      if (!coupled_) continue;
      point.slots[at(static_cast<int>(JetSlot::phi_x))].clear();
      point.weight = -q.weight;
      points.push_back(point);
    }
  return points;
}

std::vector<TablePoint> SpaceTables::cell_table(const Mesh& mesh, int cell) const {
  std::vector<TablePoint> points = gradient_table(mesh, cell);
  const std::vector<double> shares = corner_shares(mesh, cell);
  for (std::size_t l = 0; l < shares.size(); ++l) {
    TablePoint point{.weight = shares[l], .slots = {}};
    point.slots[at(static_cast<int>(JetSlot::phi))] = {{static_cast<int>(l), 1.0}};
    points.push_back(point);
  }
  return points;
}

PlacedFamily SpaceTables::motion() const {
  PlacedFamily family(density_, 2, motion_table());
  family.add_table(motion_table());
  return family;
}
PlacedFamily SpaceTables::site() const {
  PlacedFamily family(density_, 1, site_table());
  family.add_table(site_table());
  return family;
}

namespace {

Mesh cell_of(int corners) {
  Mesh mesh{.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, .vertices = {}};
  std::vector<std::int32_t> cell{0, 1, 2, 3};
  cell.resize(at(corners));
  mesh.add_cell(cell);
  return mesh;
}

}  // namespace

PlacedFamily SpaceTables::gradient(int corners) const {
  return {density_, corners, gradient_table(cell_of(corners), 0)};
}
PlacedFamily SpaceTables::cell(int corners) const { return {density_, corners, cell_table(cell_of(corners), 0)}; }

std::vector<double> corner_shares(const Mesh& mesh, int cell) {
  std::vector<double> shares(mesh.cell(cell).size(), 0.0);
  for (const CellPoint& q : cell_points(mesh, cell))
    for (std::size_t l = 0; l < shares.size(); ++l) shares[l] += q.weight * q.value[l];
  return shares;
}

std::vector<double> lumped_masses(const Mesh& mesh) {
  std::vector<double> masses(mesh.points.size(), 0.0);
  for (int c = 0; c < mesh.cells(); ++c) {
    const std::vector<double> shares = corner_shares(mesh, c);
    for (std::size_t l = 0; l < shares.size(); ++l) masses[static_cast<std::size_t>(mesh.cell(c)[l])] += shares[l];
  }
  return masses;
}

}  // namespace delf
