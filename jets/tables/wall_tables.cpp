// SPDX-License-Identifier: MIT
#include "jets/tables/wall_tables.hpp"

#include <algorithm>
#include <cmath>

namespace delf {
namespace {

/// The sum of a slot's weights in one column over the quadrature, each with `by` of its vertex.
template <class By>
double share(const StencilTable& table, JetSlot slot, int column, By by) {
  double sum = 0;
  for (const TablePoint& p : table.points)
    for (const auto& [vertex, weight] : p[slot]) {
      const Site v = table.pattern.vertices[vertex];
      if (v.space == column) sum += table.measure * p.weight * weight * by(v);
    }
  return sum;
}

TablePoint at_first_vertex(double weight, bool with_phi_t) {
  TablePoint point{.weight = weight, .slots = {}};
  point.set(JetSlot::phi, {1, 0});
  if (with_phi_t) point.set(JetSlot::phi_t, {-1, 1});
  return point;
}

}  // namespace

std::vector<StencilTable> wall_tables(const StencilTable& table) {
  const auto [left, right] = std::ranges::minmax(table.pattern.vertices, {}, &Site::space);
  if (right.space - left.space != 1 || table.nodes.size() > 1 || table.pattern.placement != Placement::every_site)
    return {};
  constexpr double round_off = 1e-12;
  std::vector<StencilTable> terms;
  for (const Placement wall : {Placement::left_wall, Placement::right_wall}) {
    const int column = wall == Placement::left_wall ? left.space : right.space;
    const double kinetic = 0.5 - share(table, JetSlot::phi_t, column, [](Site v) { return v.time; });
    const double potential = 0.5 - share(table, JetSlot::phi, column, [](Site) { return 1; });
    StencilTable term{.pattern = StencilPattern({{0, 0}, {1, 0}}, wall), .points = {}};
    if (std::abs(kinetic) > round_off) term.points.push_back(at_first_vertex(kinetic, true));
    if (std::abs(potential - kinetic) > round_off) term.points.push_back(at_first_vertex(potential - kinetic, false));
    if (!term.points.empty()) terms.push_back(std::move(term));
  }
  return terms;
}

}  // namespace delf
