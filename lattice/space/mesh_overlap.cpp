// SPDX-License-Identifier: MIT
#include "lattice/space/mesh_overlap.hpp"

#include <algorithm>
#include <array>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <limits>
#include <span>

#include "lattice/space/point_vectors.hpp"

namespace delf {
namespace {

namespace index = boost::geometry::index;
using Point = Mesh::Point;
using Corner = boost::geometry::model::point<double, 3, boost::geometry::cs::cartesian>;
using Box = boost::geometry::model::box<Corner>;

Point unit(const Point& a) {
  const double length = std::sqrt(dot(a, a));
  return {a[0] / length, a[1] / length, a[2] / length};
}

/// Relative to the length of the shorter cell: what is closer touches.
constexpr double touching = 1e-6;

/// The corners of a cell, its longest side, and the unit normal of its plane; of a segment its direction.
struct Cell {
  std::array<Point, 4> corners;
  std::size_t count;
  double length = 0;
  Point axis{};

  Cell(const Mesh& mesh, int c) : corners{}, count(mesh.cell(c).size()) {
    for (std::size_t n = 0; n < count; ++n) corners[n] = mesh.points[mesh.cell(c)[n]];
    for (std::size_t n = 0; n < count; ++n) {
      const Point side = this->side(n);
      length = std::max(length, std::sqrt(dot(side, side)));
    }
    if (count == 2) axis = side(0);
    for (std::size_t n = 1; n + 1 < count; ++n) {
      const Point area = cross(between(corners[0], corners[n]), between(corners[0], corners[n + 1]));
      for (std::size_t k = 0; k < 3; ++k) axis[k] += area[k];
    }
    axis = unit(axis);
  }
  Point side(std::size_t n) const { return between(corners[n], corners[(n + 1) % count]); }
  std::span<const Point> all() const { return {corners.data(), count}; }
};

/// True if a line across `direction`, a unit vector, has the cells on its two sides but for `slack`.
bool separates(const Point& direction, const Cell& a, const Cell& b, double slack) {
  const auto extent = [&](const Cell& cell) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Point& p : cell.all()) {
      const double s = dot(direction, between(a.corners[0], p));
      low = std::min(low, s), high = std::max(high, s);
    }
    return std::pair(low, high);
  };
  const auto [a_low, a_high] = extent(a);
  const auto [b_low, b_high] = extent(b);
  return a_high <= b_low + slack || b_high <= a_low + slack;
}

/// Two convex cells in one line or plane overlap unless the line, or the normal of a side, separates them.
bool overlap(const Cell& a, const Cell& b) {
  const double slack = touching * std::min(a.length, b.length);
  for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (const Point& p : other->all()) {
      const Point to = between(one->corners[0], p);
      const double along = dot(to, one->axis);
      const double off = one->count == 2 ? std::sqrt(std::max(0.0, dot(to, to) - along * along)) : std::abs(along);
      if (off > slack) return false;
    }
  if (a.count == 2) return !separates(a.axis, a, b, slack);
  for (const Cell* cell : {&a, &b})
    for (std::size_t n = 0; n < cell->count; ++n)
      if (separates(unit(cross(cell->axis, cell->side(n))), a, b, slack)) return false;
  return true;
}

}  // namespace

std::optional<std::pair<int, int>> overlapping_cells(const Mesh& mesh) {
  std::vector<std::pair<Box, int>> boxes;
  boxes.reserve(mesh.cells());
  for (int c = 0; c < mesh.cells(); ++c) {
    Box box;
    boost::geometry::assign_inverse(box);
    for (const auto p : mesh.cell(c)) {
      const auto& [x, y, z] = mesh.points[p];
      boost::geometry::expand(box, Corner(x, y, z));
    }
    boxes.emplace_back(box, c);
  }
  const index::rtree<std::pair<Box, int>, index::quadratic<16>> tree(boxes);
  for (const auto& [box, c] : boxes) {
    const Cell cell(mesh, c);
    int least = c;
    for (auto near = tree.qbegin(index::intersects(box)); near != tree.qend(); ++near)
      if (near->second < least && overlap(cell, Cell(mesh, near->second))) least = near->second;
    if (least < c) return std::pair(c, least);
  }
  return std::nullopt;
}

}  // namespace delf
