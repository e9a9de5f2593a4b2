// SPDX-License-Identifier: MIT
#pragma once
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "jets/tables/stencil_table.hpp"
#include "lattice/error.hpp"

namespace delf {

/// The quadrature in time: Lobatto with p_t + 1 points, at the nodes, or Gauss with p_t points.
enum class TimeQuadrature { lobatto, gauss };

/// Points and weights on [0, 1]; Σ w = 1.
struct LineRule {
  std::vector<double> points, weights;
  int size() const { return static_cast<int>(points.size()); }
};

/// 0, the zeros of P′_p and 1, moved from [−1, 1] to [0, 1]: exact to degree 2p − 1.
inline LineRule lobatto_rule(int p) {
  const auto n = static_cast<std::size_t>(p);
  LineRule rule{std::vector<double>(n + 1), std::vector<double>(n + 1)};
  for (int i = 0; 2 * i <= p; ++i) {
    double x = 2 * i == p ? 0.0 : std::cos(std::numbers::pi * i / p);
    // Newton on (1 − x²) P′_p, whose derivative is −p(p + 1) P_p
    if (i > 0 && 2 * i < p)
      for (int iteration = 0; iteration < 10; ++iteration)
        x += (1 - x * x) * boost::math::legendre_p_prime(p, x) / (p * (p + 1) * boost::math::legendre_p(p, x));
    const double legendre = boost::math::legendre_p(p, x);
    const auto low = static_cast<std::size_t>(i), high = static_cast<std::size_t>(p - i);
    rule.points[low] = (1 - x) / 2;
    rule.points[high] = (1 + x) / 2;
    rule.weights[low] = rule.weights[high] = 1 / (p * (p + 1) * legendre * legendre);
  }
  return rule;
}

/// The zeros of P_R, moved to [0, 1]: exact to degree 2R − 1.
inline LineRule gauss_rule(int R) {
  const auto n = static_cast<std::size_t>(R);
  LineRule rule{std::vector<double>(n), std::vector<double>(n)};
  std::size_t middle = n / 2;  // of the smallest zero ≥ 0; the zeros ascend
  for (const double x : boost::math::legendre_p_zeros<double>(R)) {
    const double slope = boost::math::legendre_p_prime(R, x);
    const std::size_t high = middle++, low = n - 1 - high;
    rule.points[low] = (1 - x) / 2;
    rule.points[high] = (1 + x) / 2;
    rule.weights[low] = rule.weights[high] = 1 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

/// The Lagrange basis ψ_j on given nodes, and its derivative, at any point.
class LagrangeBasis {
 public:
  explicit LagrangeBasis(std::vector<double> nodes)
      : nodes_(std::move(nodes)), weights_(nodes_.size(), 1.0), slopes_(nodes_.size() * nodes_.size(), 0.0) {
    const std::size_t n = nodes_.size();
    // b_j = 1 / Π_{m≠j} (x_j − x_m)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t m = 0; m < n; ++m)
        if (m != j) weights_[j] /= nodes_[j] - nodes_[m];
    // ψ′_j(x_m) = (b_j / b_m) / (x_m − x_j), and Σ_j ψ′_j = 0
    for (std::size_t m = 0; m < n; ++m)
      for (std::size_t j = 0; j < n; ++j) {
        if (j == m) continue;
        slopes_[m * n + j] = weights_[j] / weights_[m] / (nodes_[m] - nodes_[j]);
        slopes_[m * n + m] -= slopes_[m * n + j];
      }
  }

  /// ψ_j(x) = (b_j / (x − x_j)) / Σ_m b_m / (x − x_m)
  std::vector<double> values(double x) const {
    const std::size_t n = nodes_.size();
    std::vector<double> psi(n, 0.0);
    for (std::size_t j = 0; j < n; ++j)
      if (x == nodes_[j]) {
        psi[j] = 1;
        return psi;
      }
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) sum += psi[j] = weights_[j] / (x - nodes_[j]);
    for (double& value : psi) value /= sum;
    return psi;
  }

  /// ψ′_j(x) = Σ_m ψ_m(x) ψ′_j(x_m), exact since ψ′_j has a lower degree
  std::vector<double> slopes(double x) const {
    const std::size_t n = nodes_.size();
    const std::vector<double> psi = values(x);
    std::vector<double> slope(n, 0.0);
    for (std::size_t m = 0; m < n; ++m)
      for (std::size_t j = 0; j < n; ++j) slope[j] += psi[m] * slopes_[m * n + j];
    return slope;
  }

 private:
  std::vector<double> nodes_, weights_, slopes_;
};

/// The spacetime Galerkin element of degree (p_t, p_x): φ = Σ_ab ψ_a(t/h) ψ_b(x/k) y_ab on the Lobatto nodes.
///
///     ●──∘──○      p_t = p_x = 2. The unit cell has the p_t p_x nodes a·p_x + b, a < p_t, b < p_x: ● and ∘ of the
///     ∘──∘──∘      lowest rows; the others belong to the cells above and on the right.
///     ●──∘──○      The vertices of the pattern are all (p_t + 1)(p_x + 1) nodes, l = a (p_x + 1) + b.
///
/// The quadrature in space is Lobatto with p_x + 1 points, at the nodes.
inline StencilTable spacetime_element(int degree_time, int degree_space, TimeQuadrature quadrature) {
  const auto check = [](const std::string& key, int degree) {
    if (degree < 1 || degree > 12)
      throw BadInput(key, key + " = " + std::to_string(degree) + ": an element has a degree from 1 to 12; choose one");
  };
  check("scheme.degree_time", degree_time);
  check("scheme.degree_space", degree_space);

  const LineRule time_nodes = lobatto_rule(degree_time), space = lobatto_rule(degree_space);
  const LineRule time = quadrature == TimeQuadrature::lobatto ? time_nodes : gauss_rule(degree_time);
  const LagrangeBasis in_time(time_nodes.points), in_space(space.points);
  const auto at = [](const std::vector<double>& v, int i) { return v[static_cast<std::size_t>(i)]; };

  StencilTable element{.pattern = {}, .points = {}, .nodes = {}};
  for (int a = 0; a < degree_time; ++a)
    for (int b = 0; b < degree_space; ++b) element.nodes.push_back({at(time_nodes.points, a), at(space.points, b)});
  for (int a = 0; a <= degree_time; ++a)
    for (int b = 0; b <= degree_space; ++b)
      element.pattern.vertices.push_back({.time = a / degree_time,
                                          .space = b / degree_space,
                                          .node = a % degree_time * degree_space + b % degree_space});
  for (int r = 0; r < time.size(); ++r)
    for (int s = 0; s < space.size(); ++s) {
      const double weight = at(time.weights, r) * at(space.weights, s);
      TablePoint point{.weight = weight, .time = at(time.points, r), .space = at(space.points, s), .slots = {}};
      const std::vector<double> value_t = in_time.values(point.time), slope_t = in_time.slopes(point.time);
      const std::vector<double> value_x = in_space.values(point.space), slope_x = in_space.slopes(point.space);
      std::vector<double> phi, phi_t, phi_x;
      for (int a = 0; a <= degree_time; ++a)
        for (int b = 0; b <= degree_space; ++b) {
          phi.push_back(at(value_t, a) * at(value_x, b));
          phi_t.push_back(at(slope_t, a) * at(value_x, b));
          phi_x.push_back(at(value_t, a) * at(slope_x, b));
        }
      point.set(JetSlot::phi, phi), point.set(JetSlot::phi_t, phi_t), point.set(JetSlot::phi_x, phi_x);
      element.points.push_back(std::move(point));
    }
  // Lobatto points, where ψ_b(x_q) = δ_bq
  for (int q = 0; q < space.size(); ++q) {
    TablePoint point{.weight = at(space.weights, q), .time = 0, .space = at(space.points, q), .slots = {}};
    point.set(JetSlot::phi, in_space.values(point.space));
    point.set(JetSlot::phi_x, in_space.slopes(point.space));
    element.lower_side.push_back(std::move(point));
  }
  return element;
}

}  // namespace delf
