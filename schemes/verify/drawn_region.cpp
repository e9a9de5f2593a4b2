// SPDX-License-Identifier: MIT
#include "schemes/verify/drawn_region.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "schemes/verify/region_system.hpp"

namespace delf {
namespace {

RegionFrame frame_of(const LatticeSystem& system, Range solved) {
  RegionFrame frame{solved, std::max(1, system.height()), std::max(1, system.width()), 1};
  for (const auto& family : system.families())
    for (const Site& vertex : family->pattern().vertices) frame.nodes = std::max(frame.nodes, vertex.node + 1);
  return frame;
}

/// The first column and the last; on a circle the first is the one after the widest gap, and the last may lie
/// beyond N − 1.
std::pair<int, int> columns_of(const Region& region) {
  std::set<int> columns;
  for (const Site& site : region.sites()) columns.insert(site.space);
  const int N = region.lattice().sites();
  int left = *columns.begin(), right = *columns.rbegin();
  if (!region.lattice().is_circle() || static_cast<int>(columns.size()) == N) return {left, right};
  int widest = left + N - right, before = left;
  for (const int column : columns) {
    if (column - before > widest) widest = column - before, left = column, right = before + N;
    before = column;
  }
  return {left, right};
}

}  // namespace

RegionDrawer::RegionDrawer(const LatticeSystem& system, Range solved)
    : system_(system), patterns_(patterns_of(system)), frame_(frame_of(system, solved)) {}

int RegionDrawer::rows_wanted(const LatticeSystem& system) { return 2 * frame_of(system, {}).reach_time + 4; }

std::optional<Region> RegionDrawer::draw(const RegionRequest& request, std::mt19937_64& random) const {
  const Lattice& lattice = system_.lattice();
  if (!request.kind) {
    // Sites that no stencil holds together are no part of the formula: U becomes cl U, which is regular.
    // The first row is the first whose stencils reach no further back than equations hold; bricks keep their parity.
    int first = frame_.rows.first - frame_.reach_time;
    if (system_.placement() == Placement::brick_wall) first += first & 1;
    std::vector<Site> sites;
    for (const Site site : request.sites)
      for (int node = 0; node < frame_.nodes; ++node) sites.push_back({first + site.time, site.space, node});
    return within(Region::from_sites(lattice, patterns_, std::move(sites)));
  }
  const std::vector<Site> centres = draw_centres(*request.kind, lattice, frame_, random);
  if (centres.empty()) return std::nullopt;
  return within(region_around(lattice, patterns_, centres));
}

/// cl U, with nothing interior outside the rows on which equations hold: at natural walls few stencils touch a site,
/// and one at the edge of U may be interior to it.
std::optional<Region> RegionDrawer::within(Region region) const {
  const Lattice& lattice = system_.lattice();
  const auto outside = [&](const Site& site) { return site.time < frame_.rows.first || site.time > frame_.rows.last; };
  while (std::ranges::any_of(region.interior(), outside)) {
    std::vector<Site> sites;
    for (const Site& site : region.sites())
      if (!(outside(site) && region.in_interior(site))) sites.push_back(site);
    region = Region::from_sites(lattice, patterns_, std::move(sites));
  }
  if (region.interior().empty()) return std::nullopt;
  if (!region.regular()) region = Region::from_sites(lattice, patterns_, region.closure());
  if (region.boundary().empty()) return std::nullopt;
  return region;
}

std::string in_words(const Region& region, std::int64_t origin, std::int64_t stencils) {
  const auto& sites = region.sites();
  const auto first = origin + sites.front().time, last = origin + sites.back().time;
  if (region.lattice().sites() == 1) return fmt::format("rows {} to {}, {} stencils", first, last, stencils);
  const auto [left, right] = columns_of(region);
  return fmt::format("rows {} to {}, sites {} to {}, {} stencils", first, last, left, right, stencils);
}

std::string in_words(const LatticeSystem& system, const Node& node, std::int64_t origin) {
  std::string words = fmt::format("row {}", origin + node.site.time);
  if (system.lattice().sites() > 1) words += fmt::format(", site {}", node.site.space);
  if (system.components() > 1) words += ", " + system.component(node.component).name;
  return words;
}

}  // namespace delf
