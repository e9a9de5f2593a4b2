// SPDX-License-Identifier: MIT
#include "schemes/verify/drawn_region.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "schemes/verify/region_system.hpp"

namespace delf {
namespace {

/// How far apart two sites of one equation are: the largest stencil's height and width.
RegionFrame frame_of(const LatticeSystem& system, Range solved) {
  RegionFrame frame{solved, 1, 1, 1};
  for (const auto& family : system.families()) {
    const auto& vertices = family->pattern().vertices;
    const auto [low, high] = std::ranges::minmax(vertices, {}, &Site::time);
    const auto [left, right] = std::ranges::minmax(vertices, {}, &Site::space);
    frame.reach_time = std::max(frame.reach_time, high.time - low.time);
    frame.reach_space = std::max(frame.reach_space, right.space - left.space);
    for (const Site& vertex : vertices) frame.nodes = std::max(frame.nodes, vertex.node + 1);
  }
  return frame;
}

}  // namespace

RegionDrawer::RegionDrawer(const LatticeSystem& system, Range solved)
    : system_(system), patterns_(patterns_of(system)), frame_(frame_of(system, solved)) {}

int RegionDrawer::rows_wanted(const LatticeSystem& system) { return 2 * frame_of(system, {}).reach_time + 4; }

std::optional<Region> RegionDrawer::draw(const RegionRequest& request, std::mt19937_64& random) const {
  const Lattice& lattice = system_.lattice();
  if (!request.kind) {
    // What no stencil holds together is no part of the formula: U becomes cl U, which is regular.
    // Row 0 is the first whose stencils reach no further back than equations hold; bricks keep their parity.
    int first = frame_.rows.first - frame_.reach_time;
    if (system_.placement() == Placement::brick_wall) first += first & 1;
    std::vector<Site> sites;
    for (const Site site : request.sites)
      for (int node = 0; node < frame_.nodes; ++node) sites.push_back({first + site.time, site.space, node});
    const Region asked = Region::from_sites(lattice, patterns_, std::move(sites));
    if (asked.interior().empty()) return std::nullopt;
    return Region::from_sites(lattice, patterns_, asked.closure());
  }
  const std::vector<Site> centres = draw_centres(*request.kind, lattice, frame_, random);
  if (centres.empty()) return std::nullopt;
  Region region = region_around(lattice, patterns_, centres);
  if (region.interior().empty() || region.boundary().empty()) return std::nullopt;
  return region;
}

std::string in_words(const Region& region, std::int64_t origin, std::int64_t stencils) {
  const auto& sites = region.sites();
  const auto [left, right] = std::ranges::minmax(sites, {}, &Site::space);
  const auto first = origin + sites.front().time, last = origin + sites.back().time;
  if (region.lattice().sites() == 1) return fmt::format("rows {} to {}, {} stencils", first, last, stencils);
  return fmt::format("rows {} to {}, sites {} to {}, {} stencils", first, last, left.space, right.space, stencils);
}

std::string in_words(const LatticeSystem& system, const Node& node, std::int64_t origin) {
  std::string words = fmt::format("row {}", origin + node.site.time);
  if (system.lattice().sites() > 1) words += fmt::format(", site {}", node.site.space);
  if (system.components() > 1) words += ", " + system.component(node.component).name;
  return words;
}

}  // namespace delf
