// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "jets/tables/line_basis.hpp"
#include "jets/tables/line_rule.hpp"
#include "jets/tables/stencil_table.hpp"
#include "lattice/error.hpp"

namespace delf {

/// The quadrature in time: Lobatto with p_t + 1 points, at the nodes, or Gauss with p_t points.
enum class TimeQuadrature { lobatto, gauss };

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

  const LineRule time_nodes = lobatto_rule(degree_time + 1), space = lobatto_rule(degree_space + 1);
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
