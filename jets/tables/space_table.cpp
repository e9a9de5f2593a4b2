// SPDX-License-Identifier: MIT
#include "jets/tables/space_table.hpp"

#include <cstddef>
#include <string>
#include <utility>

#include "lattice/error.hpp"

namespace delf {

StencilTable point_space() {
  TablePoint point{.slots = {}};
  point.set(JetSlot::phi, {1.0});
  return {.pattern = StencilPattern({{0, 0}}), .points = {point}};
}

StencilTable element_space(const LineBasis& basis, const LineRule& rule) {
  const int degree = basis.size() - 1;
  StencilTable element{.pattern = {}, .points = {}, .nodes = {}};
  for (int b = 0; b < degree; ++b) element.nodes.push_back({0, basis.places[b]});
  for (int b = 0; b <= degree; ++b)
    element.pattern.vertices.push_back({.time = 0, .space = b / degree, .node = b % degree});
  for (std::size_t s = 0; s < rule.points.size(); ++s) {
    TablePoint point{.weight = rule.weights[s], .time = 0, .space = rule.points[s], .slots = {}};
    point.set(JetSlot::phi, basis.values(point.space));
    point.set(JetSlot::phi_x, basis.slopes(point.space));
    element.points.push_back(std::move(point));
  }
  return element;
}

StencilTable spectral_space(int degree) {
  if (degree < 1 || degree > 12)
    throw BadInput("scheme.degree_space", "scheme.degree_space = " + std::to_string(degree) +
                                              ": an element has a degree from 1 to 12; choose one");
  const LineRule rule = lobatto_rule(degree + 1);
  return element_space(lagrange_basis(rule.points), rule);
}

StencilTable linear_space() { return element_space(lagrange_basis({0, 1}), gauss_rule(2)); }

std::vector<double> pair_weights(int p) {
  std::vector<double> weights;
  double quotient = 2;  // 2 p!² / ((p − m)! (p + m)!)
  for (int m = 1; m <= p; ++m) {
    quotient *= static_cast<double>(p - m + 1) / (p + m);
    weights.push_back(m % 2 == 1 ? quotient : -quotient);
  }
  return weights;
}

StencilTable pair_space(const std::vector<double>& pairs) {
  const int p = static_cast<int>(pairs.size());
  StencilTable table{.pattern = {}, .points = {}};
  for (int m = 0; m <= p; ++m) table.pattern.vertices.push_back({.time = 0, .space = m});
  for (int m = 1; m <= p; ++m)
    for (const int end : {0, m}) {
      std::vector phi(table.pattern.vertices.size(), 0.0), phi_x = phi;
      phi[end] = 1;
      phi_x[m] = 1. / m;
      phi_x[0] = -1. / m;
      TablePoint point{.weight = pairs[m - 1] / 2, .time = 0, .space = static_cast<double>(end), .slots = {}};
      point.set(JetSlot::phi, phi), point.set(JetSlot::phi_x, phi_x);
      table.points.push_back(std::move(point));
    }
  return table;
}

}  // namespace delf
