// SPDX-License-Identifier: MIT
#include "lattice/space/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "lattice/index.hpp"
#include "lattice/space/point_vectors.hpp"

namespace delf {
namespace {

using Point = Mesh::Point;

/// A side a → b of a cell.
struct Side {
  std::int32_t low, high, cell;
  bool forward;  ///< it runs from low to high
};

std::vector<Side> sorted_sides(const Mesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(mesh.vertices.size());
  for (int c = 0; c < mesh.cells(); ++c) {
    const auto corners = mesh.cell(c);
    for (std::size_t n = 0; n < corners.size(); ++n) {
      const auto a = corners[n], b = corners[(n + 1) % corners.size()];
      sides.push_back({std::min(a, b), std::max(a, b), c, a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.cell) < std::tie(b.low, b.high, b.cell);
  });
  return sides;
}

/// Twice the area of the triangle at a corner of a cell, with the sign of its orientation in a plane.
Point corner_area(const Mesh& mesh, int cell, std::size_t n) {
  const std::size_t m = mesh.cell(cell).size();
  const Point& p = mesh.corner(cell, n);
  return cross(between(p, mesh.corner(cell, (n + 1) % m)), between(p, mesh.corner(cell, (n + m - 1) % m)));
}

/// The place of a point, as one of its cells has it.
const Point& place_in_cell(const Mesh& mesh, int cell, std::int32_t point) {
  const auto corners = mesh.cell(cell);
  return mesh.corner(cell, at(std::ranges::find(corners, point) - corners.begin()));
}

class FaultFinder {
 public:
  explicit FaultFinder(const Mesh& mesh) : mesh_(mesh), flat_(mesh.coordinates() < 3) {}

  std::optional<MeshFault> find() {
    if (mesh_.cells() == 0) return MeshFault{0, "has no cells; give one at least"};
    std::vector<int> uses(mesh_.points.size(), 0);
    for (int c = 0; c < mesh_.cells(); ++c) {
      if (const auto fault = of_cell(c)) return fault;
      for (const auto p : mesh_.cell(c)) ++uses[p];
    }
    for (std::size_t p = 0; p < uses.size(); ++p) {
      const int line = line_of(mesh_.point_lines, p);
      if (uses[p] == 0) return MeshFault{line, point(p) + " is in no cell; remove it"};
      if (mesh_.dimension == 1 && uses[p] > 2)
        return doubled().value_or(
            MeshFault{line, point(p) + " is the end of more than two segments; make curves of them"});
    }
    const auto fault = mesh_.dimension == 1 ? std::nullopt : of_sides();
    return fault ? doubled().value_or(*fault) : fault;
  }

 private:
  std::string point(std::size_t p) const { return "point " + std::to_string(mesh_.point_number(p)); }
  std::string cell(std::int32_t c) const { return "cell " + std::to_string(mesh_.cell_number(at(c))); }
  static int line_of(const std::vector<int>& lines, std::size_t n) { return n < lines.size() ? lines[n] : 0; }
  MeshFault fault_of(std::int32_t cell, const std::string& what) const {
    return {line_of(mesh_.cell_lines, at(cell)), this->cell(cell) + " " + what};
  }

  // Two cells of the same points, in any order: what their sides say of them is of no use.
  std::optional<MeshFault> doubled() const {
    std::vector<std::pair<std::vector<std::int32_t>, std::int32_t>> cells;
    for (int c = 0; c < mesh_.cells(); ++c) {
      const auto corners = mesh_.cell(c);
      cells.emplace_back(std::vector(corners.begin(), corners.end()), c);
      std::ranges::sort(cells.back().first);
    }
    std::ranges::sort(cells);
    for (std::size_t n = 1; n < cells.size(); ++n)
      if (cells[n].first == cells[n - 1].first)
        return fault_of(cells[n].second, "has the same points as " + cell(cells[n - 1].second) +
                                             ": it is there twice; remove one of them");
    return std::nullopt;
  }

  std::optional<MeshFault> of_cell(int c) const {
    const auto corners = mesh_.cell(c);
    const std::size_t m = corners.size();
    if (m < 2 || m > 4 || (mesh_.dimension == 1) != (m == 2))
      return fault_of(c, "has " + std::to_string(m) + " corners; cells are segments, or triangles and quadrilaterals");
    for (const auto p : corners)
      if (p < 0 || at(p) >= mesh_.points.size())
        return fault_of(c, "has point " + std::to_string(p) + ", and there are " + std::to_string(mesh_.points.size()) +
                               ", counted from 0; correct it");
    for (std::size_t n = 0; n < m; ++n)
      for (std::size_t k = 0; k < n; ++k)
        if (corners[k] == corners[n]) return fault_of(c, "is degenerate: a point is there twice; correct it");
    constexpr double flat = 1e-12;  // of an area, relative to the longest side's square
    double longest = 0;
    for (std::size_t n = 0; n < m; ++n)
      longest = std::max(longest, norm(between(mesh_.corner(c, n), mesh_.corner(c, (n + 1) % m))));
    if (!(longest > 0) || !std::isfinite(longest))
      return fault_of(c, "is degenerate: its corners are one point; move or remove it");
    if (m == 2) return std::nullopt;
    Point mean{};
    for (std::size_t n = 0; n < m; ++n)
      for (std::size_t k = 0; k < 3; ++k) mean[k] += corner_area(mesh_, c, n)[k];
    for (std::size_t n = 0; n < m; ++n) {
      const Point area = corner_area(mesh_, c, n);
      if (norm(area) <= flat * longest * longest)
        return fault_of(c, "is degenerate: three corners lie on a line; move or remove it");
      if (flat_ && m == 3 && area[2] < 0) return fault_of(c, "is listed clockwise; list its points the other way");
      if (m == 4 && dot(area, mean) <= 0)
        return fault_of(c, "is not convex, or crosses itself; reorder its points or cut it");
    }
    if (flat_ && mean[2] < 0) return fault_of(c, "is listed clockwise; list its points the other way");
    return std::nullopt;
  }

  std::optional<MeshFault> of_sides() const {
    const std::vector<Side> sides = sorted_sides(mesh_);
    std::vector<Side> outer;
    for (std::size_t n = 0; n < sides.size();) {
      std::size_t end = n + 1;
      while (end < sides.size() && sides[end].low == sides[n].low && sides[end].high == sides[n].high) ++end;
      const std::string side = "the side of points " + std::to_string(mesh_.point_number(at(sides[n].low))) + " and " +
                               std::to_string(mesh_.point_number(at(sides[n].high)));
      if (end - n > 2) return fault_of(sides[n + 2].cell, "is the third at " + side + "; a side has two cells at most");
      if (end - n == 2 && sides[n].forward == sides[n + 1].forward)
        return fault_of(sides[n + 1].cell, "and " + cell(sides[n].cell) + " run along " + side +
                                               " the same way: one is flipped; list its points the other way");
      if (end - n == 1) outer.push_back(sides[n]);
      n = end;
    }
    return hanging(outer);
  }

  // A point of the boundary inside a side of the boundary: searched in the order of x.
  std::optional<MeshFault> hanging(const std::vector<Side>& outer) const {
    std::vector<std::int32_t> points;
    for (const Side& s : outer) points.push_back(s.low), points.push_back(s.high);
    const auto x = [&](std::int32_t p) { return mesh_.points[p][0]; };
    std::sort(points.begin(), points.end(), [&](auto a, auto b) { return std::pair(x(a), a) < std::pair(x(b), b); });
    points.erase(std::unique(points.begin(), points.end()), points.end());
    for (const Side& s : outer) {
      const Point &a = place_in_cell(mesh_, s.cell, s.low), &b = place_in_cell(mesh_, s.cell, s.high);
      const Point along = between(a, b);
      const double length2 = dot(along, along), slack = 1e-9 * std::sqrt(length2);
      const double low = std::min(a[0], b[0]) - slack, high = std::max(a[0], b[0]) + slack;
      auto p = std::lower_bound(points.begin(), points.end(), low, [&](auto q, double value) { return x(q) < value; });
      for (; p != points.end() && x(*p) <= high; ++p) {
        if (*p == s.low || *p == s.high) continue;
        const Point to = between(a, mesh_.points[*p]);
        const double share = dot(to, along) / length2;
        if (share > 0 && share < 1 && norm(cross(to, along)) <= slack * std::sqrt(length2))
          return MeshFault{line_of(mesh_.cell_lines, at(s.cell)), point(at(*p)) + " hangs in the middle of a side of " +
                                                                      cell(s.cell) + "; cut that cell there"};
      }
    }
    return std::nullopt;
  }

  const Mesh& mesh_;
  bool flat_;
};

}  // namespace

int Mesh::coordinates() const {
  int most = 1;
  for (const Point& p : points) most = p[2] != 0 ? 3 : p[1] != 0 ? std::max(most, 2) : most;
  return std::max(most, dimension);
}

double measure(const Mesh& mesh, int cell) {
  const auto corners = mesh.cell(cell);
  const auto point = [&](std::size_t n) -> const Point& { return mesh.corner(cell, n); };
  if (corners.size() == 2) return norm(between(point(0), point(1)));
  Point twice{};
  for (std::size_t n = 1; n + 1 < corners.size(); ++n)
    for (std::size_t k = 0; k < 3; ++k)
      twice[k] += cross(between(point(0), point(n)), between(point(0), point(n + 1)))[k];
  return twice[0] == 0 && twice[1] == 0 ? 0.5 * twice[2] : 0.5 * norm(twice);
}

double shortest_edge(const Mesh& mesh, int cell) {
  const auto corners = mesh.cell(cell);
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < corners.size(); ++n)
    shortest = std::min(shortest, norm(between(mesh.corner(cell, n), mesh.corner(cell, (n + 1) % corners.size()))));
  return shortest;
}

double shortest_edge(const Mesh& mesh) {
  double shortest = std::numeric_limits<double>::infinity();
  for (int c = 0; c < mesh.cells(); ++c) shortest = std::min(shortest, shortest_edge(mesh, c));
  return shortest;
}

std::vector<std::array<std::int32_t, 2>> boundary_sides(const Mesh& mesh) {
  std::vector<std::array<std::int32_t, 2>> outer;
  if (mesh.dimension == 1) {
    std::vector<char> segments(mesh.points.size(), 0);
    for (const auto p : mesh.vertices) ++segments[p];
    for (std::size_t p = 0; p < segments.size(); ++p)
      if (const auto end = static_cast<std::int32_t>(p); segments[p] == 1) outer.push_back({end, end});
    return outer;
  }
  const std::vector<Side> sides = sorted_sides(mesh);
  for (std::size_t n = 0; n < sides.size(); ++n) {
    const auto same = [&](std::size_t m) {
      return m < sides.size() && sides[m].low == sides[n].low && sides[m].high == sides[n].high;
    };
    if (!same(n + 1) && !(n > 0 && same(n - 1))) outer.push_back({sides[n].low, sides[n].high});
  }
  return outer;
}

std::vector<std::int32_t> boundary_points(const Mesh& mesh) {
  std::vector<std::int32_t> points;
  for (const auto& [a, b] : boundary_sides(mesh)) points.push_back(a), points.push_back(b);
  std::ranges::sort(points);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

std::vector<std::pair<std::int32_t, double>> side_shares(const Mesh& mesh,
                                                         std::span<const std::array<std::int32_t, 2>> sides) {
  std::map<std::int32_t, double> shares;
  const std::vector<Side> all = mesh.dimension == 1 ? std::vector<Side>() : sorted_sides(mesh);
  for (const auto& [a, b] : sides) {
    if (a == b) {
      shares[a] += 1;
      continue;
    }
    const std::pair ends(std::min(a, b), std::max(a, b));
    const auto side = std::ranges::lower_bound(all, ends, {}, [](const Side& s) { return std::pair(s.low, s.high); });
    const double half = 0.5 * norm(between(place_in_cell(mesh, side->cell, a), place_in_cell(mesh, side->cell, b)));
    shares[a] += half, shares[b] += half;
  }
  return {shares.begin(), shares.end()};
}

std::vector<char> held_points(const Mesh& mesh, bool otherwise, std::span<const PartCondition> conditions) {
  std::map<std::array<std::int32_t, 2>, bool> held;
  for (const auto& side : boundary_sides(mesh)) held[side] = otherwise;
  for (const auto& [name, is_held] : conditions) {
    const auto part = std::ranges::find(mesh.parts, name, &Mesh::Part::name);
    if (part == mesh.parts.end()) throw std::out_of_range(name);
    for (const auto& [a, b] : part->sides) held[{std::min(a, b), std::max(a, b)}] = is_held;
  }
  std::vector<char> points(mesh.points.size(), 0);
  for (const auto& [side, is_held] : held)
    if (is_held) points[side[0]] = points[side[1]] = 1;
  return points;
}

std::optional<MeshFault> find_fault(const Mesh& mesh) { return FaultFinder(mesh).find(); }

}  // namespace delf
