// SPDX-License-Identifier: MIT
#include "jets/tables/mirror_table.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <vector>

namespace delf {
namespace {

/// A site by its distance from the wall and its row.
struct AtWall {
  int space, time;
  auto operator<=>(const AtWall&) const = default;
};

/// A point with the weights of the sites of its slots, and what a slope of 1 a site at the wall adds to them.
struct PointAtWall {
  double weight, time, space;
  std::array<std::map<AtWall, double>, jet_slots> slots;
  std::array<double, jet_slots> of_slope{};

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
        if (!any || before(site.space, found)) any = true, found = site.space;
    return found;
  }
};

/// x ↦ −x: derivatives of odd order in x change their sign.
PointAtWall turned(const PointAtWall& p) {
  PointAtWall q{p.weight, p.time, p.space == 0 ? 0 : -p.space, {}};
  for (std::size_t s = 0; s < p.slots.size(); ++s) {
    const double sign = slot_powers[s].space % 2 != 0 ? -1 : 1;
    for (const auto& [site, weight] : p.slots[s]) q.slots[s][{-site.space, site.time}] = sign * weight;
    q.of_slope[s] = p.of_slope[s] == 0 ? 0 : -sign * p.of_slope[s];  // the slope too changes its sign
  }
  return q;
}

/// The point with sites within in place of their mirror images.
PointAtWall folded(const PointAtWall& p, Mirror mirror) {
  PointAtWall q{p.weight, p.time, p.space, {}};
  for (std::size_t s = 0; s < p.slots.size(); ++s) {
    auto& to = q.slots[s];
    for (const auto& [site, weight] : p.slots[s]) {
      const AtWall image{-site.space, site.time};
      if (site.space >= 0) to[site] += weight;
      else if (mirror == Mirror::even) to[image] += weight, q.of_slope[s] += 2 * site.space * weight;
      else to[{0, site.time}] += 2 * weight, to[image] -= weight;
    }
    std::erase_if(to, [](const auto& entry) { return entry.second == 0; });
  }
  return q;
}

}  // namespace

MirrorTable mirror_table(const StencilTable& table, Placement wall, Mirror mirror) {
  if (table.nodes.size() > 1 || !table.tests.empty())
    throw std::logic_error("delf: mirror images are those of tables of sites");
  const bool left = wall == Placement::left_mirror || wall == Placement::left_wall;
  const auto [first, last] = std::ranges::minmax(table.pattern.vertices, {}, &Site::space);
  const auto [low, high] = std::ranges::minmax(table.pattern.vertices, {}, &Site::time);
  const int from = left ? first.space : -last.space, to = left ? last.space : -first.space;

  // The stencils that are not whole have anchors with from + anchor < 0 ≤ to + anchor as seen from the wall.
  std::vector<PointAtWall> points;
  for (int anchor = -to; anchor + from < 0; ++anchor)
    for (const TablePoint& given : table.points) {
      PointAtWall p{given.weight, given.time, given.space, {}};
      for (std::size_t s = 0; s < given.slots.size(); ++s)
        for (const auto& [vertex, weight] : given.slots[s]) {
          const Site& v = table.pattern.vertices[vertex];
          p.slots[s][{v.space, v.time}] += weight;
        }
      if (!left) p = turned(p);
      PointAtWall placed{p.weight, p.time, p.space + anchor, {}};
      for (std::size_t s = 0; s < p.slots.size(); ++s)
        for (const auto& [site, weight] : p.slots[s]) placed.slots[s][{site.space + anchor, site.time}] = weight;
      if (placed.most() <= 0 && placed.least() < 0) continue;
      if (placed.least() < 0) placed.weight /= 2;
      placed = folded(placed.space < 0 ? turned(placed) : placed, mirror);
      const auto same = std::ranges::find_if(points, [&](const PointAtWall& q) {
        return q.slots == placed.slots && q.time == placed.time && q.space == placed.space &&
               q.of_slope == placed.of_slope;
      });
      if (same != points.end()) same->weight += placed.weight;
      else points.push_back(std::move(placed));
    }

  int reach = 0;
  for (const PointAtWall& p : points) reach = std::max(reach, p.most());
  MirrorTable at_wall{{.pattern = StencilPattern({}, wall), .points = {}, .measure = table.measure}, {}};
  for (int time = low.time; time <= high.time; ++time)
    for (int site = 0; site <= reach; ++site)
      at_wall.table.pattern.vertices.push_back({.time = time, .space = left ? site : -site});
  for (const PointAtWall& p : points) {
    const PointAtWall& placed = left ? p : turned(p);
    TablePoint point{.weight = p.weight, .time = p.time, .space = placed.space, .slots = {}};
    for (std::size_t s = 0; s < placed.slots.size(); ++s)
      for (const auto& [site, weight] : placed.slots[s])
        point.slots[s].push_back({(site.time - low.time) * (reach + 1) + std::abs(site.space), weight});
    at_wall.table.points.push_back(std::move(point));
    at_wall.of_slope.push_back(placed.of_slope);
  }
  return at_wall;
}

}  // namespace delf
