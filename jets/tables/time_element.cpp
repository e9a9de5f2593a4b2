// SPDX-License-Identifier: MIT
#include "jets/tables/time_element.hpp"

#include <cstddef>
#include <utility>
#include <vector>

#include "lattice/error.hpp"

namespace delf {

StencilTable time_element(const LineBasis& basis, const LineRule& of_a_span, Continuity continuity) {
  const LineRule rule = on_spans(of_a_span, basis.knots);
  const bool broken = continuity == Continuity::multipliers;
  if (!broken && !basis.has_end_nodes())
    throw BadInput(
        "scheme.continuity",
        "scheme.continuity = shared: the basis has no nodes at both ends; use multipliers, or a basis that has");
  StencilTable element{.pattern = {}, .points = {}, .nodes = {{}}};
  element.pattern.vertices = {{.time = 0, .space = 0, .node = 0}};
  const int inside = broken ? basis.size() : basis.size() - 2;
  for (int j = 0; j < inside; ++j) {
    element.nodes.push_back({.time = basis.places[broken ? j : j + 1]});
    element.pattern.vertices.push_back({.time = 0, .space = 0, .node = j + 1});
  }
  if (!broken) element.pattern.vertices.push_back({.time = 1, .space = 0, .node = 0});

  for (std::size_t i = 0; i < rule.points.size(); ++i) {
    TablePoint point{.weight = rule.weights[i], .time = rule.points[i], .slots = {}};
    std::vector<double> phi = basis.values(point.time), phi_t = basis.slopes(point.time);
    // no point reads the vertex of a broken element
    if (broken) phi.insert(phi.begin(), 0.0), phi_t.insert(phi_t.begin(), 0.0);
    point.set(JetSlot::phi, phi), point.set(JetSlot::phi_t, phi_t);
    element.points.push_back(std::move(point));
  }
  TablePoint lower{.slots = {}};
  lower.set(JetSlot::phi, {1.0});
  element.lower_side.push_back(std::move(lower));
  return element;
}

}  // namespace delf
