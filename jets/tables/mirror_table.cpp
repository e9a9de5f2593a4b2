// SPDX-License-Identifier: MIT
#include "jets/tables/mirror_table.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <vector>

namespace delf {
namespace {

/// A point with the weights of the sites of its slots, counted from the wall.
struct PointAtWall {
  double weight, time, space;
  std::array<std::map<int, double>, jet_slots> slots;

  int least() const {
    return extreme([](int a, int b) { return a < b; });
  }
  int most() const {
    return extreme([](int a, int b) { return a > b; });
  }

 private:
  template <class Before>
  int extreme(Before before) const {
    bool any = false;
    int found = 0;
    for (const auto& slot : slots)
      for (const auto& [site, of_site] : slot)
        if (!any || before(site, found)) any = true, found = site;
    return found;
  }
};

/// x ↦ −x: derivatives of odd order in x change their sign.
PointAtWall turned(const PointAtWall& p) {
  PointAtWall q{p.weight, p.time, p.space == 0 ? 0 : -p.space, {}};
  for (std::size_t s = 0; s < p.slots.size(); ++s)
    for (const auto& [site, weight] : p.slots[s]) q.slots[s][-site] = slot_powers[s].space % 2 != 0 ? -weight : weight;
  return q;
}

/// With the sites within in place of their mirror images.
PointAtWall folded(const PointAtWall& p, Mirror mirror) {
  PointAtWall q{p.weight, p.time, p.space, {}};
  for (std::size_t s = 0; s < p.slots.size(); ++s) {
    auto& to = q.slots[s];
    for (const auto& [site, weight] : p.slots[s]) {
      if (site >= 0) to[site] += weight;
      else if (mirror == Mirror::even) to[-site] += weight;
      else to[0] += 2 * weight, to[-site] -= weight;
    }
    std::erase_if(to, [](const auto& entry) { return entry.second == 0; });
  }
  return q;
}

}  // namespace

StencilTable mirror_table(const StencilTable& table, Placement wall, Mirror mirror) {
  if (table.nodes.size() > 1 || !table.tests.empty() ||
      std::ranges::any_of(table.pattern.vertices, [](Site v) { return v.time != 0; }))
    throw std::logic_error("delf: mirror images are those of tables of one row");
  const bool left = wall == Placement::left_mirror;
  const auto [first, last] = std::ranges::minmax(table.pattern.vertices, {}, &Site::space);
  const int from = left ? first.space : -last.space, to = left ? last.space : -first.space;

  // Of the stencils that are not whole, anchored at from + anchor < 0 ≤ to + anchor as seen from the wall.
  std::vector<PointAtWall> points;
  for (int anchor = -to; anchor + from < 0; ++anchor)
    for (const TablePoint& given : table.points) {
      PointAtWall p{given.weight, given.time, given.space, {}};
      for (std::size_t s = 0; s < given.slots.size(); ++s)
        for (const auto& [vertex, weight] : given.slots[s])
          p.slots[s][table.pattern.vertices[static_cast<std::size_t>(vertex)].space] += weight;
      if (!left) p = turned(p);
      PointAtWall placed{p.weight, p.time, p.space + anchor, {}};
      for (std::size_t s = 0; s < p.slots.size(); ++s)
        for (const auto& [site, weight] : p.slots[s]) placed.slots[s][site + anchor] = weight;
      if (placed.most() <= 0 && placed.least() < 0) continue;
      if (placed.least() < 0) placed.weight /= 2;
      placed = folded(placed.space < 0 ? turned(placed) : placed, mirror);
      const auto same = std::ranges::find_if(points, [&](const PointAtWall& q) {
        return q.slots == placed.slots && q.time == placed.time && q.space == placed.space;
      });
      if (same != points.end()) same->weight += placed.weight;
      else points.push_back(std::move(placed));
    }

  int reach = 0;
  for (const PointAtWall& p : points) reach = std::max(reach, p.most());
  StencilTable at_wall{.pattern = StencilPattern({}, wall), .points = {}, .measure = table.measure};
  for (int site = 0; site <= reach; ++site)
    at_wall.pattern.vertices.push_back({.time = 0, .space = left ? site : -site});
  for (const PointAtWall& p : points) {
    const PointAtWall& placed = left ? p : turned(p);
    TablePoint point{.weight = p.weight, .time = p.time, .space = placed.space, .slots = {}};
    for (std::size_t s = 0; s < placed.slots.size(); ++s)
      for (const auto& [site, weight] : placed.slots[s]) point.slots[s].push_back({std::abs(site), weight});
    at_wall.points.push_back(std::move(point));
  }
  return at_wall;
}

}  // namespace delf
