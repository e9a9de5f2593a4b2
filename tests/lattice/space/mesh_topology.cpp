// SPDX-License-Identifier: MIT
#include "lattice/space/mesh_topology.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "lattice/space/coincident_points.hpp"
#include "lattice/space/mesh_overlap.hpp"
#include "tests/catch.hpp"

namespace {

using namespace delf;

/// m × n quadrilaterals, closed along one or both of their directions: a cylinder, a torus.
Mesh tube(std::int32_t m, std::int32_t n, bool closed) {
  Mesh mesh{.points = {}, .vertices = {}};
  const std::int32_t rows = closed ? n : n + 1;
  for (std::int32_t j = 0; j < rows; ++j)
    for (std::int32_t i = 0; i < m; ++i) {
      const double a = 2 * std::numbers::pi * i / m, b = 2 * std::numbers::pi * j / n;
      const double r = closed ? 3 + std::cos(b) : 1;
      mesh.points.push_back({r * std::cos(a), r * std::sin(a), closed ? std::sin(b) : 0.5 * j});
    }
  for (std::int32_t j = 0; j < n; ++j)
    for (std::int32_t i = 0; i < m; ++i) {
      const std::int32_t up = (j + 1) % rows, next = (i + 1) % m;
      mesh.add_cell(std::array{j * m + i, j * m + next, up * m + next, up * m + i});
    }
  return mesh;
}

/// Two squares of 2 × 2 cells beside each other, the points between them listed for each.
Mesh seam(double apart = 0) {
  Mesh mesh = rectangle_mesh(1, 1, 2, 2, true);
  const Mesh left = mesh;
  for (const Mesh::Point& p : left.points) mesh.points.push_back({p[0] + 1 + apart, p[1], 0});
  for (int c = 0; c < left.cells(); ++c) {
    std::array<std::int32_t, 4> corners{};
    for (std::size_t l = 0; l < 4; ++l) corners[l] = left.cell(c)[l] + static_cast<std::int32_t>(left.points.size());
    mesh.add_cell(corners);
  }
  return mesh;
}

TEST_CASE("the Euler characteristic and the curves of the boundary tell spheres, discs, tubes and tori apart") {
  const auto words = [](const Mesh& mesh) { return in_words(topology(mesh), mesh.dimension); };
  CHECK(words(icosahedral_sphere(2)) == "Euler characteristic 2, no boundary curves");
  CHECK(words(rectangle_mesh(3, 2, 6, 5, false)) == "Euler characteristic 1, 1 boundary curve");
  CHECK(words(tube(8, 5, false)) == "Euler characteristic 0, 2 boundary curves");
  CHECK(words(tube(8, 6, true)) == "Euler characteristic 0, no boundary curves");
  CHECK(words(graded_interval(10, 11, 1.2)) == "Euler characteristic 1, 2 ends");
  CHECK(words(seam()) == "Euler characteristic 2, 2 boundary curves, in 2 pieces");
}

TEST_CASE("points that are there twice along a seam are found, and made one within a distance") {
  const auto found = coincident_points(seam());
  REQUIRE(found);
  CHECK(found->first == 9);
  CHECK(found->second == 2);
  const Mesh one = merged(seam(), 1e-9);
  CHECK(one.points.size() == 15);
  CHECK_FALSE(find_fault(one));
  CHECK(in_words(topology(one), 2) == "Euler characteristic 1, 1 boundary curve");
  CHECK(one.point_number(9) == 10);  // what the file calls it
  // a gap of a millionth of a side is one still, and one of a thousandth is not
  CHECK(coincident_points(seam(2e-7)));
  CHECK_FALSE(coincident_points(seam(1e-3)));
  CHECK(merged(seam(1e-3), 1e-4).points.size() == 18);
  CHECK(merged(seam(1e-3), 2e-3).points.size() == 15);
  for (const Mesh& mesh : {icosahedral_sphere(3), tube(8, 6, true), graded_interval(10, 200, 0.9)})
    CHECK_FALSE(coincident_points(mesh));
}

TEST_CASE("cells that cover a part of space twice are found, and none where cells only touch") {
  for (const Mesh& mesh : {icosahedral_sphere(3), tube(8, 5, false), tube(8, 6, true), graded_interval(10, 200, 0.9),
                           seam(), rectangle_mesh(3, 2, 6, 5, false), rectangle_mesh(3, 2, 6, 5, true)})
    CHECK_FALSE(overlapping_cells(mesh));
  using Pair = std::pair<int, int>;
  CHECK(overlapping_cells(seam(-0.1)) == Pair(4, 1));
  // a strip that winds twice around its middle: each cell is sound, and so are all sides
  Mesh twice{.points = {}, .vertices = {}};
  for (int i = 0; i <= 16; ++i)
    for (const double r : {1.0, 2.0})
      twice.points.push_back(
          {r * std::cos(2 * std::numbers::pi * i / 8.5), r * std::sin(2 * std::numbers::pi * i / 8.5), 0});
  for (std::int32_t i = 0; i < 16; ++i) twice.add_cell(std::array{2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2});
  REQUIRE_FALSE(find_fault(twice));
  CHECK(overlapping_cells(twice) == Pair(8, 0));
  // a line that goes back on itself, and a sheet of paper that is folded flat in space
  Mesh line{.dimension = 1, .points = {{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}}, .vertices = {}};
  line.add_cell(std::array{0, 1}), line.add_cell(std::array{1, 2});
  REQUIRE_FALSE(find_fault(line));
  CHECK(overlapping_cells(line) == Pair(1, 0));
  Mesh paper{.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 1}, {0.1, 0.2, 0.2}}, .vertices = {}};
  paper.add_cell(std::array{0, 1, 2, 3});
  paper.add_cell(std::array{1, 0, 4});
  REQUIRE_FALSE(find_fault(paper));
  CHECK(overlapping_cells(paper) == Pair(1, 0));
  paper.points[4] = {0.1, -0.2, -0.2};
  CHECK_FALSE(overlapping_cells(paper));
  paper.points[4] = {0.1, 0.2, 0.3};  // at an angle
  CHECK_FALSE(overlapping_cells(paper));
}

}  // namespace
