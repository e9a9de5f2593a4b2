// SPDX-License-Identifier: MIT
#include "jets/tables/table_product.hpp"

#include <cstddef>
#include <vector>

#include "lattice/index.hpp"

namespace delf {
namespace {

using Entries = std::vector<TablePoint::Entry>;

/// y_ab weighs what a weighs in time times what b weighs in space.
Entries product(const Entries& time, const Entries& space, int width) {
  Entries entries;
  for (const auto& [a, of_time] : time)
    for (const auto& [b, of_space] : space) entries.push_back({a * width + b, of_time * of_space});
  return entries;
}
TablePoint product(const TablePoint& r, const TablePoint& s, int width) {
  TablePoint point{.weight = r.weight * s.weight, .time = r.time, .space = s.space, .slots = {}};
  point.own.weight = s.own.weight, point.own.place = s.own.place;
  const auto fill = [&](JetSlot slot, JetSlot of_time, JetSlot of_space) {
    point.slots[at(slot)] = product(r[of_time], s[of_space], width);
    const std::vector<int>& own = s.own.slots[at(of_space)];
    for (std::size_t a = 0; a < r[of_time].size(); ++a) {
      std::vector<int>& all = point.own.slots[at(slot)];
      all.insert(all.end(), own.begin(), own.end());
    }
  };
  fill(JetSlot::phi, JetSlot::phi, JetSlot::phi);
  fill(JetSlot::phi_t, JetSlot::phi_t, JetSlot::phi);
  fill(JetSlot::phi_x, JetSlot::phi, JetSlot::phi_x);
  return point;
}

}  // namespace

StencilTable product(const StencilTable& time, const StencilTable& space) {
  const int width = space.pattern.size(), nodes = static_cast<int>(space.nodes.size());
  StencilTable table{.pattern = {}, .points = {}, .nodes = {}, .measure = time.measure * space.measure};
  for (const NodePosition& a : time.nodes)
    for (const NodePosition& b : space.nodes) table.nodes.push_back({a.time, b.space});
  for (const Site& a : time.pattern.vertices)
    for (const Site& b : space.pattern.vertices)
      table.pattern.vertices.push_back({.time = a.time, .space = b.space, .node = a.node * nodes + b.node});
  const auto multiply = [&](const std::vector<TablePoint>& points, std::vector<TablePoint>& to) {
    for (const TablePoint& r : points)
      for (const TablePoint& s : space.points) to.push_back(product(r, s, width));
  };
  multiply(time.points, table.points);
  multiply(time.tests, table.tests);
  table.lower_side = space.points;
  return table;
}

StencilTable at_one_site(const StencilTable& product) {
  StencilTable table{.pattern = {}, .points = {}, .nodes = product.nodes};
  std::vector<int> vertices;  // of the product, by those of the site
  for (int l = 0; l < product.pattern.size(); ++l) {
    const Site& v = product.pattern.vertices[l];
    if (v.space != 0 || product.nodes[v.node].space != 0) continue;
    vertices.push_back(l), table.pattern.vertices.push_back(v);
  }
  if (vertices.empty()) return table;
  const std::size_t width = at(product.pattern.size()) / vertices.size();
  // each point of time is there once for every point of space
  const std::size_t of_space = product.lower_side.size();
  const auto sum = [&](const std::vector<TablePoint>& points) {
    std::vector<TablePoint> sums;
    for (std::size_t n = 0; n < points.size(); n += of_space) {
      TablePoint point{.weight = 0, .time = points[n].time, .slots = {}};
      for (std::size_t s = 0; s < of_space; ++s) point.weight += points[n + s].weight;
      for (const JetSlot slot : {JetSlot::phi, JetSlot::phi_t}) {
        std::vector<double> weights(vertices.size(), 0.0);
        for (const auto& [vertex, weight] : points[n][slot]) weights[at(vertex) / width] += weight;
        point.set(slot, weights);
      }
      sums.push_back(std::move(point));
    }
    return sums;
  };
  table.points = sum(product.points), table.tests = sum(product.tests);
  return table;
}

}  // namespace delf
