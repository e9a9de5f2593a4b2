// SPDX-License-Identifier: MIT
#include "lattice/region_shapes.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "lattice/index.hpp"

namespace delf {
namespace {

constexpr std::array names{"rectangle", "staircase", "hole", "wall", "slab", "random"};

/// An integer from low … high.
int between(std::mt19937_64& random, int low, int high) {
  return high <= low ? low : low + static_cast<int>(random() % static_cast<std::uint64_t>(high - low + 1));
}

void add(std::vector<Site>& centres, int time, int space, int nodes) {
  for (int node = 0; node < nodes; ++node) centres.push_back({time, space, node});
}

/// Columns first … first + count − 1 for a region that leaves some of space out.
struct Columns {
  int first, count;
};
Columns draw_columns(const Lattice& lattice, int least, int most, std::mt19937_64& random) {
  const int count = between(random, std::min(least, most), most);
  return {lattice.is_circle() ? between(random, 0, lattice.sites() - 1) : between(random, 0, lattice.sites() - count),
          count};
}

}  // namespace

const char* to_string(RegionKind kind) { return names[at(kind)]; }

const std::vector<RegionKind>& region_kinds() {
  static const std::vector<RegionKind> all{RegionKind::box,  RegionKind::staircase, RegionKind::hole,
                                           RegionKind::wall, RegionKind::slab,      RegionKind::random};
  return all;
}

std::vector<Site> draw_centres(RegionKind kind, const Lattice& lattice, const RegionFrame& frame,
                               std::mt19937_64& random) {
  std::vector<Site> centres;
  const int N = lattice.sites(), rows = frame.rows.last - frame.rows.first + 1;
  // On a circle the stencils of the centres must leave something out.
  const int room = lattice.is_circle() ? N - 2 * frame.reach_space - 1 : N;
  const int most = std::min(room, frame.most_columns);
  const bool everywhere = kind == RegionKind::slab;
  if (rows < 1 || (!everywhere && (lattice.space() == Space::point || most < 1))) return {};

  if (everywhere) {
    const int height = between(random, std::min(2, rows), rows), first = between(random, 0, rows - height);
    for (int j = first; j < first + height; ++j)
      for (int i = 0; i < N; ++i) add(centres, frame.rows.first + j, i, frame.nodes);
  } else if (kind == RegionKind::box || kind == RegionKind::wall) {
    if (kind == RegionKind::wall && lattice.space() != Space::interval) return {};
    const int height = between(random, 1, rows), first = between(random, 0, rows - height);
    Columns columns = draw_columns(lattice, 2, most, random);
    if (kind == RegionKind::wall) columns.first = random() % 2 ? 0 : N - columns.count;
    for (int j = first; j < first + height; ++j)
      for (int i = 0; i < columns.count; ++i) add(centres, frame.rows.first + j, columns.first + i, frame.nodes);
  } else if (kind == RegionKind::staircase) {
    if (most < 3) return {};
    const Columns columns = draw_columns(lattice, 3, most, random);
    const int step = std::max(1, (columns.count - 1) / rows), way = random() % 2 ? 1 : -1;
    for (int j = 0; j < rows; ++j)
      for (int i = j * step; i < columns.count; ++i)
        add(centres, way > 0 ? frame.rows.first + j : frame.rows.last - j, columns.first + i, frame.nodes);
  } else if (kind == RegionKind::hole) {
    // A ring of centres one site wide; what lies further inside than their stencils reach is the hole.
    const int high = 2 * frame.reach_time + 3, wide = 2 * frame.reach_space + 3;
    if (rows < high || most < wide) return {};
    const int height = between(random, high, rows), first = between(random, 0, rows - height);
    const Columns columns = draw_columns(lattice, wide, most, random);
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < columns.count; ++i)
        if (j == 0 || j == height - 1 || i == 0 || i == columns.count - 1)
          add(centres, frame.rows.first + first + j, columns.first + i, frame.nodes);
  } else {
    const Columns columns = draw_columns(lattice, 2, most, random);
    const int size = between(random, 1, std::max(1, rows * columns.count / 2));
    std::vector<std::pair<int, int>> grown{{between(random, 0, rows - 1), between(random, 0, columns.count - 1)}};
    std::set<std::pair<int, int>> taken(grown.begin(), grown.end());
    for (int tries = 0; static_cast<int>(grown.size()) < size && tries < 40 * size; ++tries) {
      constexpr std::array<std::pair<int, int>, 4> ways{{{0, 1}, {0, -1}, {1, 0}, {-1, 0}}};
      const auto [j, i] = grown[random() % grown.size()];
      const auto [dj, di] = ways[random() % ways.size()];
      const std::pair next{j + dj, i + di};
      if (next.first < 0 || next.first >= rows || next.second < 0 || next.second >= columns.count) continue;
      if (taken.insert(next).second) grown.push_back(next);
    }
    for (const auto& [j, i] : grown) add(centres, frame.rows.first + j, columns.first + i, frame.nodes);
  }
  return centres;
}

namespace {

/// Calls use(site) for the vertices of all stencils that touch a site.
template <class Use>
void for_neighbours(const Stencils& all, Site site, const Use& use) {
  for (int family = 0; family < static_cast<int>(all.families().size()); ++family)
    for (int l = 0; l < all.families()[family].size(); ++l)
      all.with_vertex(family, l, site, [&](Site anchor) {
        for (int m = 0; m < all.families()[family].size(); ++m) use(all.vertex(family, anchor, m));
      });
}

}  // namespace

std::vector<Site> draw_connected(const Region& within, int count, std::mt19937_64& random) {
  if (within.interior().empty()) return {};
  std::vector<Site> drawn{within.interior()[random() % within.interior().size()]}, rim;
  std::set<Site> seen(drawn.begin(), drawn.end());
  const auto take_neighbours = [&](Site site) {
    for_neighbours(within.all(), site, [&](Site other) {
      if (within.in_interior(other) && seen.insert(other).second) rim.push_back(other);
    });
  };
  take_neighbours(drawn[0]);
  while (static_cast<int>(drawn.size()) < count && !rim.empty()) {
    std::swap(rim[random() % rim.size()], rim.back());
    drawn.push_back(rim.back());
    rim.pop_back();
    take_neighbours(drawn.back());
  }
  return drawn;
}

Region region_around(const Stencils& all, const std::vector<Site>& centres, Region::IsData is_data) {
  std::vector<Site> sites;
  for (const Site centre : centres) for_neighbours(all, centre, [&](Site site) { sites.push_back(site); });
  return Region::from_sites(all, std::move(sites), std::move(is_data));
}

}  // namespace delf
