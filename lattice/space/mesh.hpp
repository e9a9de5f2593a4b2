// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lattice/index.hpp"

namespace delf {

/// A space made of cells: segments of a line or a curve, triangles and quadrilaterals of a plane or a surface. Cells of a
/// plane are listed counterclockwise; those of a surface all alike, so that neighbours run along their edge in opposite
/// directions.
struct Mesh {
  using Point = std::array<double, 3>;

  int dimension = 2;  ///< of the cells: 1, or 2
  std::vector<Point> points;
  std::vector<std::int32_t> first{0}, vertices;
  /// The places of the corners, in the order of `vertices`, where points that lie apart were joined (joined()): a cell at the
  /// seam has a corner on the other side. Empty: those of the points.
  std::vector<Point> places = {};
  /// A part of the boundary that has a name: its sides (a, b), or the points (p, p) of a mesh of segments.
  struct Part {
    std::string name;
    std::vector<std::array<std::int32_t, 2>> sides;
    std::vector<int> lines = {};  ///< of a text
  };
  std::vector<Part> parts = {};
  std::vector<int> point_lines = {}, cell_lines = {};  ///< of the file that they were read from; empty if generated

  /// The numbers that the file gives them, as Gmsh does; empty: those from 0.
  std::vector<std::int64_t> point_tags = {}, cell_tags = {};

  std::int64_t point_number(std::size_t p) const {
    return p < point_tags.size() ? point_tags[p] : static_cast<std::int64_t>(p);
  }
  std::int64_t cell_number(std::size_t c) const {
    return c < cell_tags.size() ? cell_tags[c] : static_cast<std::int64_t>(c);
  }
  int cells() const { return static_cast<int>(first.size()) - 1; }
  std::span<const std::int32_t> cell(int c) const {
    const std::size_t i = c;
    return {vertices.data() + first[i], at(first[i + 1] - first[i])};
  }
  /// Corner l of a cell.
  const Point& corner(int c, std::size_t l) const {
    const std::size_t n = at(first[at(c)]) + l;
    return places.empty() ? points[at(vertices[n])] : places[n];
  }
  void add_cell(std::span<const std::int32_t> corners) {
    vertices.insert(vertices.end(), corners.begin(), corners.end());
    first.push_back(static_cast<std::int32_t>(vertices.size()));
  }
  /// The number of x, y, z that the points need: 1, 2 or 3.
  int coordinates() const;
};

/// Length or area of a cell; a triangle or quadrilateral of a plane that is listed clockwise has a negative one.
double measure(const Mesh&, int cell);
/// Length of the shortest side of all cells.
double shortest_edge(const Mesh&);
/// The shortest edge of one cell.
double shortest_edge(const Mesh&, int cell);
/// Sides (a, b), a < b, that only one cell has, each once and in order; of a mesh of segments its ends, (p, p).
std::vector<std::array<std::int32_t, 2>> boundary_sides(const Mesh&);
/// Points on the boundary, each once, in order: ends of curves, and points of sides that only one cell has.
std::vector<std::int32_t> boundary_points(const Mesh&);

/// ∫ N_i ds of each point over some sides of the boundary, each point once and in order: half the lengths of its sides, and 1 at
/// the end of a curve.
std::vector<std::pair<std::int32_t, double>> side_shares(const Mesh&,
                                                         std::span<const std::array<std::int32_t, 2>> sides);

/// A condition at the sides of a part: their points are held, or free.
struct PartCondition {
  std::string part;
  bool held;
};
/// [point]: true for those of a side that is held. Sides of the boundary that no condition names are held if `otherwise`. A
/// point between a side that is held and one that is free is held. Throws std::out_of_range for a part that there is none of.
std::vector<char> held_points(const Mesh&, bool otherwise, std::span<const PartCondition> = {});

/// The fault of a mesh, and the line of its file that has it (0: none).
struct MeshFault {
  int line = 0;
  std::string what;
};
/// The first fault: a cell that is degenerate, listed the wrong way round or not convex, a side of more than two cells, a
/// point that hangs in the middle of a side or that no cell has.
std::optional<MeshFault> find_fault(const Mesh&);

/// N points on 0 … length, each cell `ratio` times as long as the one before; its ends are left and right.
Mesh graded_interval(double length, int points, double ratio);
/// [0, width] × [0, height] in nx × ny rectangles, each cut in two triangles along alternating diagonals unless
/// `quadrilaterals`; its sides are left, right, bottom and top.
Mesh rectangle_mesh(double width, double height, int nx, int ny, bool quadrilaterals);
/// The unit sphere: an icosahedron, each triangle cut in four `level` times: 10·4^level + 2 points.
Mesh icosahedral_sphere(int level);

}  // namespace delf
