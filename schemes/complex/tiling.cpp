// SPDX-License-Identifier: MIT
#include "schemes/complex/tiling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "lattice/space/mesh_overlap.hpp"

namespace delf {
namespace {

using std::numbers::pi;
using Position = Complex::Position;

/// A number in a message.
std::string text_of(double x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", x);
  return text.data();
}

/// What the stencils around a site add up to.
struct Around {
  std::array<double, 2> slopes{}, absolute{};  ///< Σ w ∂φ_t/∂y, Σ w ∂φ_x/∂y, and of the absolute terms
  double angle = 0, covered = 0;  ///< Σ of the outlines' angles; the same, each times weight/area of its outline
  bool has_parts = false;         ///< motion, site or gradient

  /// The larger of both sums, relative to its terms.
  double relative() const {
    double most = 0;
    for (std::size_t c = 0; c < 2; ++c)
      if (absolute[c] > 0) most = std::max(most, std::abs(slopes[c]) / absolute[c]);
    return most;
  }
};

/// The vertices of a shape around it, counterclockwise in (x, t), without one in its middle.
std::vector<std::size_t> around(const StencilTable& table) {
  const std::vector<Site>& shape = table.pattern.vertices;
  double t = 0, x = 0;
  for (const Site& v : shape) t += v.time, x += v.space;
  t /= static_cast<double>(shape.size()), x /= static_cast<double>(shape.size());
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t l = 0; l < shape.size(); ++l)
    if (const double up = shape[l].time - t, along = shape[l].space - x; std::hypot(up, along) > 1e-9)
      order.emplace_back(std::atan2(up, along), l);
  std::ranges::sort(order);
  std::vector<std::size_t> vertices;
  for (const auto& [angle, l] : order) vertices.push_back(l);
  return vertices;
}

/// From one direction (x, t) counterclockwise to another: 0 … 2π.
double monodromy(double x, double t, double to_x, double to_t) {
  const double angle = std::atan2(x * to_t - t * to_x, x * to_x + t * to_t);
  return angle < 0 ? angle + 2 * pi : angle;
}

class Tiler {
 public:
  explicit Tiler(const StencilList& list)
      : list_(list), around_(list.sites.size()), density_(list.stencils.size(), 0) {}

  Tiling find() {
    Tiling found;
    bool tiles = true;
    for (std::size_t n = 0; n < list_.stencils.size(); ++n) {
      const StencilList::Entry& e = list_.stencils[n];
      const StencilTable* const table = stencil_shape(e.shape)->table;
      if (!table) {
        for (const int s : e.sites) around_[s].has_parts = true;
        tiles = false;
        continue;
      }
      add(n, *table, found.area);
      tiles = tiles && std::abs(density_[n] - 1) <= exact;
    }
    examine(found);
    if (tiles && !found.fault) lay_out(found);
    return found;
  }

 private:
  static constexpr double exact = 1e-6, noticed = 0.02;

  /// One stencil, at its sites.
  void add(std::size_t n, const StencilTable& table, double& area) {
    const StencilList::Entry& e = list_.stencils[n];
    const std::vector<Position> positions = list_.positions(e);
    const std::vector<std::size_t> order = around(table);
    double outline = 0, weight = 0;
    for (std::size_t m = 0; m < order.size(); ++m) {
      const Position &a = positions[order[m]], &b = positions[order[(m + 1) % order.size()]];
      outline += 0.5 * ((a[1] - positions[0][1]) * (b[0] - positions[0][0]) -
                        (b[1] - positions[0][1]) * (a[0] - positions[0][0]));
    }
    for (const TablePoint& p : placed_points(table, positions)) {
      const double w = p.weight * e.share.value_or(table.measure);
      weight += w;
      for (const auto& [c, slot] : {std::pair(0, JetSlot::phi_t), std::pair(1, JetSlot::phi_x)})
        for (const auto& entry : p[slot]) {
          Around& site = around_[e.sites[entry.vertex]];
          site.slopes[c] += w * entry.weight, site.absolute[c] += std::abs(w * entry.weight);
        }
    }
    area += weight;
    density_[n] = weight / outline;
    std::vector<double> angles(positions.size(), 2 * pi);  // of a vertex in the middle
    for (std::size_t m = 0; m < order.size(); ++m) {
      const Position &p = positions[order[m]], &next = positions[order[(m + 1) % order.size()]],
                     &before = positions[order[(m + order.size() - 1) % order.size()]];
      angles[order[m]] = monodromy(next[1] - p[1], next[0] - p[0], before[1] - p[1], before[0] - p[0]);
    }
    for (std::size_t l = 0; l < positions.size(); ++l) {
      around_[e.sites[l]].angle += angles[l];
      around_[e.sites[l]].covered += density_[n] * angles[l];
    }
  }

  /// Sites in the middle of their neighbours whose equations are not those of a tiling.
  void examine(Tiling& found) const {
    std::vector<char> suspected(list_.sites.size(), 0);
    bool any = false;
    for (std::size_t s = 0; s < list_.sites.size(); ++s) {
      const SiteRole role = list_.sites[s].role;
      if (role == SiteRole::given || role == SiteRole::final || around_[s].has_parts) continue;
      if (around_[s].relative() > noticed) suspected[s] = 1, any = true;
    }
    if (!any) return;
    std::vector<std::vector<std::array<double, 2>>> neighbours(list_.sites.size());  // directions x, t
    std::vector<std::vector<std::size_t>> stencils(list_.sites.size());
    for (std::size_t n = 0; n < list_.stencils.size(); ++n) {
      const StencilList::Entry& e = list_.stencils[n];
      if (std::ranges::none_of(e.sites, [&](int s) { return suspected[s]; })) continue;
      const std::vector<Position> positions = list_.positions(e);
      for (std::size_t l = 0; l < positions.size(); ++l) {
        if (!suspected[e.sites[l]]) continue;
        stencils[e.sites[l]].push_back(n);
        for (const Position& p : positions)
          if (&p != &positions[l]) neighbours[e.sites[l]].push_back({p[1] - positions[l][1], p[0] - positions[l][0]});
      }
    }
    double worst = 0;
    for (std::size_t s = 0; s < list_.sites.size(); ++s) {
      if (!suspected[s] || !is_inside(neighbours[s])) continue;
      const double relative = around_[s].relative();
      const double covered = std::max(around_[s].angle, around_[s].covered) / (2 * pi);
      if (covered < 1 - noticed) {
        found.gaps.push_back("stencils cover " + text_of(covered) + " of the surroundings of " + name(s) +
                             ", whose equation takes the rest for a natural boundary; add the stencil that is "
                             "missing, unless the complex is to end there");
      } else if (relative > worst) {
        worst = relative;
        found.fault = fault_at(s, stencils[s], relative);
      }
    }
  }

  std::string name(std::size_t s) const {
    const Position& p = list_.sites[s].position;
    return "site " + std::to_string(s) + " (t = " + text_of(p[0]) + ", x = " + text_of(p[1]) + ")";
  }

  MeshFault fault_at(std::size_t s, const std::vector<std::size_t>& stencils, double relative) const {
    const auto [least, most] = std::ranges::minmax_element(stencils, {}, [&](std::size_t n) { return density_[n]; });
    std::string what = "the stencils around " + name(s) + " do not tile: of a constant slope they leave " +
                       text_of(100 * relative) + " % of their terms, and should leave 0; ";
    int line = list_.sites[s].line;
    if (density_[*most] > density_[*least] * (1 + noticed)) {
      const StencilList::Entry& e = list_.stencils[*most];
      line = e.line;
      what += "stencil " + std::to_string(*most) + " (" + e.shape + ") stands for " + text_of(density_[*most]) +
              " of its area, and stencil " + std::to_string(*least) + " for " + text_of(density_[*least]) +
              ": correct a share, or remove a stencil";
    } else {
      what += "remove a stencil, or add one that is missing";
    }
    return {line, what};
  }

  /// True if directions lie all round, with less than a half turn between one and the next, of coordinates that are scaled
  /// by their own largest differences. A boundary may be bent a little.
  static bool is_inside(const std::vector<std::array<double, 2>>& directions) {
    constexpr double bent = 0.3;
    std::array<double, 2> scale{};
    for (const auto& d : directions)
      for (std::size_t c = 0; c < 2; ++c) scale[c] = std::max(scale[c], std::abs(d[c]));
    if (!(scale[0] > 0) || !(scale[1] > 0)) return false;
    std::vector<double> angles;
    for (const auto& d : directions) angles.push_back(std::atan2(d[1] / scale[1], d[0] / scale[0]));
    std::ranges::sort(angles);
    double widest = angles.front() + 2 * pi - angles.back();
    for (std::size_t n = 1; n < angles.size(); ++n) widest = std::max(widest, angles[n] - angles[n - 1]);
    return widest < pi - bent;
  }

  /// The outlines as cells, those that lie across the seam of a circle on both of its sides.
  void lay_out(Tiling& found) const {
    Mesh mesh{.points = {}, .vertices = {}}, apart = mesh;
    std::vector<std::size_t> stencil_of;
    for (const StencilList::Site& s : list_.sites) mesh.points.push_back({s.position[1], s.position[0], 0});
    const double L = list_.circumference;
    for (std::size_t n = 0; n < list_.stencils.size(); ++n) {
      const StencilList::Entry& e = list_.stencils[n];
      const std::vector<Position> positions = list_.positions(e);
      const std::vector<std::size_t> order = around(*stencil_shape(e.shape)->table);
      if (order.size() > 4 || order.size() != positions.size()) return;
      std::vector<std::int32_t> corners;
      for (const std::size_t l : order) corners.push_back(e.sites[l]);
      mesh.add_cell(corners);
      const auto [low, high] = std::ranges::minmax(positions, {}, [](const Position& p) { return p[1]; });
      const double home = L > 0 ? -L * std::floor(low[1] / L) : 0;
      for (const double shift : {home, home - L}) {
        if (shift != home && !(high[1] + shift > 0)) break;
        corners.clear();
        for (const std::size_t l : order) {
          corners.push_back(static_cast<std::int32_t>(apart.points.size()));
          apart.points.push_back({positions[l][1] + shift, positions[l][0], 0});
        }
        apart.add_cell(corners);
        stencil_of.push_back(n);
        if (L == 0) break;
      }
    }
    if (const auto twice = overlapping_cells(apart)) {
      const auto [later, first] =
          std::minmax(stencil_of[twice->first], stencil_of[twice->second], std::greater<std::size_t>());
      const int line = list_.stencils[first].line;
      found.fault = {list_.stencils[later].line,
                     "stencil " + std::to_string(later) + " (" + list_.stencils[later].shape + ") overlaps stencil " +
                         std::to_string(first) + (line > 0 ? " (line " + std::to_string(line) + ")" : "") +
                         "; move their sites, or remove one"};
      return;
    }
    found.cells = std::move(mesh);
  }

  const StencilList& list_;
  std::vector<Around> around_;
  std::vector<double> density_;  ///< weight of each stencil over the area of its outline
};

}  // namespace

Tiling tiling_of(const StencilList& list) { return Tiler(list).find(); }

}  // namespace delf
