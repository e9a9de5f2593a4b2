// SPDX-License-Identifier: MIT
#include "jets/tables/flux_table.hpp"

#include <cstddef>
#include <utility>

#include "jets/tables/line_rule.hpp"
#include "lattice/index.hpp"

namespace delf {
namespace {

/// θ(q⁻ + τ (q⁺ − q⁻))·(q⁺ − q⁻) at the points τ of the rule.
std::vector<FluxPoint> straight_line(const LineRule& rule) {
  std::vector<FluxPoint> points;
  for (std::size_t i = 0; i < rule.points.size(); ++i) {
    const double tau = rule.points[i];
    points.push_back({rule.weights[i], {1 - tau, 0, tau}, {-1, 0, 1}});
  }
  return points;
}

/// Adds w θ(Q)·α, with Q and α sums over the vertices.
void add(StencilTable& table, double w, const std::vector<double>& place, const std::vector<double>& increment) {
  for (const bool moving : {true, false}) {
    TablePoint point{.weight = moving ? w : -w, .slots = {}};
    point.set(JetSlot::phi, place);
    if (moving) point.set(JetSlot::phi_t, increment);
    table.points.push_back(std::move(point));
  }
}

/// A table on some nodes of the unit cell, all of them in row 0.
StencilTable on_nodes(const std::vector<int>& nodes) {
  StencilTable table{.pattern = {}, .points = {}};
  for (const int node : nodes) {
    table.pattern.vertices.push_back({.time = 0, .space = 0, .node = node});
    if (at(node) >= table.nodes.size()) table.nodes.resize(at(node) + 1);
  }
  return table;
}

}  // namespace

const std::vector<NamedFlux>& named_fluxes() {
  static const std::vector<NamedFlux> fluxes{{"midpoint", straight_line(gauss_rule(1))},
                                             {"trapezoid", straight_line(lobatto_rule(2))},
                                             {"gauss2", straight_line(gauss_rule(2))},
                                             {"simpson", straight_line(lobatto_rule(3))},
                                             {"one-sided", {{1, {1, 0, 0}, {-1, 0, 1}}}, NamedFlux::Observed::momentum},
                                             {"nodal",
                                              {{0.5, {1, 0, 0}, {-1, 1, 0}},
                                               {0.5, {0, 1, 0}, {-1, 1, 0}},
                                               {0.5, {0, 1, 0}, {0, -1, 1}},
                                               {0.5, {0, 0, 1}, {0, -1, 1}}},
                                              NamedFlux::Observed::vertex}};
  return fluxes;
}

std::vector<FluxPoint> gauge_of_jumps(double nu) {
  if (nu == 0) return {};
  return {{-nu, {0, 0, 1}, {0, 0, 1}}, {nu, {1, 0, 0}, {1, 0, 0}}};
}

StencilTable flux_table(const std::vector<FluxPoint>& points, const FluxNodes& nodes) {
  // Only those of the three that the flux reads.
  std::vector<int> read;
  std::vector<std::size_t> which;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    for (const FluxPoint& p : points)
      if (p.place[n] != 0 || p.increment[n] != 0) {
        read.push_back(nodes[n]), which.push_back(n);
        break;
      }
  StencilTable table = on_nodes(read);
  for (const FluxPoint& p : points) {
    std::vector<double> place, increment;
    for (const std::size_t n : which) place.push_back(p.place[n]), increment.push_back(p.increment[n]);
    add(table, p.weight, place, increment);
  }
  return table;
}

StencilTable momentum_tie_table(const FluxNodes& nodes, int multiplier) {
  StencilTable table = on_nodes({nodes[0], nodes[1], multiplier});
  add(table, 1, {0, 1, 0}, {0, 0, 1});
  add(table, -1, {1, 0, 0}, {0, 0, 1});
  return table;
}

}  // namespace delf
