// SPDX-License-Identifier: MIT
#include "jets/tables/cell_points.hpp"

#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace delf {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector scaled(const Vector& a, double s) { return {s * a[0], s * a[1], s * a[2]}; }
Vector unit(const Vector& a) { return scaled(a, 1 / std::sqrt(dot(a, a))); }

/// The point with N_l and its derivatives by the cell's own coordinates ξ, η. With tangents g_ξ = Σ x_l ∂_ξN_l and g_η:
/// e₁ = g_ξ/|g_ξ|, e₂ ⟂ e₁; ∂_aN = Σ_b (G⁻¹)_ba ∂_bN, G_ba = g_b·e_a.
CellPoint placed(const Mesh& mesh, int cell, double weight, std::vector<double> value,
                 const std::vector<std::vector<double>>& by_own) {
  const std::size_t corners = value.size();
  std::vector<Vector> g(by_own.size(), Vector{});
  for (std::size_t b = 0; b < g.size(); ++b)
    for (std::size_t l = 0; l < corners; ++l)
      for (std::size_t k = 0; k < 3; ++k) g[b][k] += by_own[b][l] * mesh.corner(cell, l)[k];
  const Vector e1 = unit(g[0]);
  const double g11 = dot(g[0], e1);
  CellPoint point{weight * g11, std::move(value), {}};
  std::vector<double> first(corners), second(corners);
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

}  // namespace

std::vector<CellPoint> cell_points(const Mesh& mesh, int cell) {
  const std::size_t corners = mesh.cell(cell).size();
  if (corners == 2) return {placed(mesh, cell, 1, {0.5, 0.5}, {{-1, 1}})};
  if (corners == 3) return {placed(mesh, cell, 0.5, {1. / 3, 1. / 3, 1. / 3}, {{-1, 1, 0}, {-1, 0, 1}})};
  std::vector<CellPoint> points;  // Gauss, 2 × 2 points of the unit square
  const double a = 0.5 - std::sqrt(3.0) / 6;
  for (const double u : {a, 1 - a})
    for (const double v : {a, 1 - a})
      points.push_back(placed(mesh, cell, 0.25, {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v},
                              {{-(1 - v), 1 - v, v, -v}, {-(1 - u), -u, u, 1 - u}}));
  return points;
}

std::vector<double> corner_shares(const Mesh& mesh, int cell) {
  std::vector<double> shares(mesh.cell(cell).size(), 0.0);
  for (const CellPoint& q : cell_points(mesh, cell))
    for (std::size_t l = 0; l < shares.size(); ++l) shares[l] += q.weight * q.value[l];
  return shares;
}

std::vector<TablePoint> gradient_table(const Mesh& mesh, int cell, bool coupled) {
  std::vector<TablePoint> points;
  for (const CellPoint& q : cell_points(mesh, cell))
    for (const std::vector<double>& slope : q.slopes) {
      TablePoint point{.weight = q.weight, .slots = {}};
      const auto set = [&](JetSlot slot, const std::vector<double>& weights) {
        for (std::size_t l = 0; l < weights.size(); ++l)
          point.slots[at(static_cast<int>(slot))].push_back({static_cast<int>(l), weights[l]});
      };
      if (coupled) set(JetSlot::phi, q.value);
      TablePoint without = point;
      set(JetSlot::phi_x, slope);
      points.push_back(std::move(point));
      without.weight = -q.weight;
      if (coupled) points.push_back(std::move(without));
    }
  return points;
}

std::vector<TablePoint> cell_table(const Mesh& mesh, int cell, bool coupled) {
  std::vector<TablePoint> points = gradient_table(mesh, cell, coupled);
  const std::vector<double> shares = corner_shares(mesh, cell);
  for (std::size_t l = 0; l < shares.size(); ++l) {
    TablePoint point{.weight = shares[l], .slots = {}};
    point.slots[at(static_cast<int>(JetSlot::phi))] = {{static_cast<int>(l), 1.0}};
    points.push_back(std::move(point));
  }
  return points;
}

std::vector<double> lumped_masses(const Mesh& mesh) {
  std::vector<double> masses(mesh.points.size(), 0.0);
  for (int c = 0; c < mesh.cells(); ++c) {
    const std::vector<double> shares = corner_shares(mesh, c);
    for (std::size_t l = 0; l < shares.size(); ++l) masses[mesh.cell(c)[l]] += shares[l];
  }
  return masses;
}

}  // namespace delf
