// SPDX-License-Identifier: MIT
#include "lattice/space/mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "lattice/space/mesh_refinement.hpp"
#include "tests/catch.hpp"

namespace {

using namespace delf;

double total(const Mesh& mesh) {
  double sum = 0;
  for (int c = 0; c < mesh.cells(); ++c) sum += measure(mesh, c);
  return sum;
}

/// The points that are held where these sides of a rectangle are, by their numbers.
std::vector<int> held(const Mesh& mesh, bool otherwise, std::vector<PartCondition> conditions) {
  const std::vector<char> all = held_points(mesh, otherwise, conditions);
  std::vector<int> list;
  for (std::size_t p = 0; p < all.size(); ++p)
    if (all[p]) list.push_back(static_cast<int>(p));
  return list;
}

TEST_CASE("sides of a boundary are held or free, and a point between both is held") {
  const Mesh mesh = rectangle_mesh(2, 1, 2, 1, false);  // points 0 1 2 below 3 4 5
  CHECK(held(mesh, false, {}).empty());
  CHECK(held(mesh, true, {}).size() == 6);
  CHECK(held(mesh, false, {{"left", true}}) == std::vector{0, 3});
  CHECK(held(mesh, true, {{"bottom", false}}) == std::vector{0, 2, 3, 4, 5});
  CHECK(held(mesh, true, {{"bottom", false}, {"left", false}, {"right", false}}) == std::vector{3, 4, 5});
  CHECK_THROWS_AS(held(mesh, true, {{"inflow", false}}), std::out_of_range);
  const Mesh line = graded_interval(10, 11, 1.2);
  CHECK(held(line, false, {{"right", true}}) == std::vector{10});
}

TEST_CASE("parts of a boundary stay parts of it where a mesh is refined") {
  Mesh fine = refined(refined(rectangle_mesh(2, 1, 2, 1, true)));
  for (const Mesh::Part& part : fine.parts) {
    CHECK(part.sides.size() == (part.name == "left" || part.name == "right" ? 4 : 8));
    const auto& held = held_points(fine, false, std::vector{PartCondition{part.name, true}});
    for (std::size_t p = 0; p < held.size(); ++p) {
      const auto [x, y, z] = fine.points[p];
      const bool on = part.name == "left"     ? x == 0
                      : part.name == "right"  ? x == 2
                      : part.name == "bottom" ? y == 0
                                              : y == 1;
      CHECK(static_cast<bool>(held[p]) == on);
    }
  }
  fine.parts[0].sides.push_back({0, 1});  // the check can fail
  CHECK(held(fine, false, {{"left", true}}).size() == 6);
}

TEST_CASE("points of a sphere are numbered along rows: most have their neighbours where the next point has its own") {
  const Mesh sphere = icosahedral_sphere(5);
  std::vector<std::set<int>> apart(sphere.points.size());
  for (int c = 0; c < sphere.cells(); ++c)
    for (const int i : sphere.cell(c))
      for (const int j : sphere.cell(c)) apart[i].insert(j - i);
  int alike = 0;
  for (std::size_t i = 1; i < apart.size(); ++i) alike += apart[i] == apart[i - 1] ? 1 : 0;
  CHECK(sphere.points.size() == 10242);
  CHECK(std::ranges::none_of(apart, &std::set<int>::empty));
  CHECK(alike > 0.8 * static_cast<double>(apart.size()));
}

TEST_CASE("generated meshes are sound, and fill their space") {
  for (const bool quadrilaterals : {false, true}) {
    const Mesh plane = rectangle_mesh(3, 2, 6, 5, quadrilaterals);
    CHECK_FALSE(find_fault(plane));
    CHECK(total(plane) == Approx(6));
    CHECK(boundary_points(plane).size() == 22);
  }
  const Mesh line = graded_interval(10, 11, 1.2);
  CHECK_FALSE(find_fault(line));
  CHECK(total(line) == Approx(10));
  CHECK(boundary_points(line) == std::vector<std::int32_t>{0, 10});
  CHECK(shortest_edge(line) == Approx(10 * 0.2 / (std::pow(1.2, 10) - 1)));
  const Mesh sphere = icosahedral_sphere(3);
  CHECK_FALSE(find_fault(sphere));
  CHECK(sphere.points.size() == 642);
  CHECK(boundary_points(sphere).empty());
  CHECK(total(sphere) == Approx(4 * std::numbers::pi).epsilon(0.02));
}

TEST_CASE("a refined mesh fills the same space with halved sides, its old points first") {
  for (const Mesh& mesh :
       {rectangle_mesh(3, 2, 6, 4, false), rectangle_mesh(3, 2, 6, 4, true), graded_interval(10, 11, 0.9)}) {
    const Mesh fine = refined(mesh);
    CHECK_FALSE(find_fault(fine));
    CHECK(fine.cells() == mesh.cells() * (mesh.dimension == 1 ? 2 : 4));
    CHECK(total(fine) == Approx(total(mesh)));
    CHECK(shortest_edge(fine) == Approx(shortest_edge(mesh) / 2));
    CHECK(std::equal(mesh.points.begin(), mesh.points.end(), fine.points.begin()));
  }
}

TEST_CASE("a mesh with a fault is refused, with the line of the cell or point") {
  Mesh mesh = rectangle_mesh(2, 2, 2, 2, true);
  mesh.point_lines = {10, 11, 12, 13, 14, 15, 16, 17, 18};
  mesh.cell_lines = {20, 21, 22, 23};
  const auto fault = [&] {
    const auto found = find_fault(mesh);
    return found ? std::to_string(found->line) + ": " + found->what : "none";
  };
  REQUIRE(fault() == "none");
  SECTION("clockwise") {
    std::swap(mesh.vertices[5], mesh.vertices[7]);
    CHECK(fault() == "21: cell 1 is listed clockwise; list its points the other way");
  }
  SECTION("flipped, on a surface") {
    mesh = icosahedral_sphere(1);
    std::swap(mesh.vertices[5 * 3], mesh.vertices[5 * 3 + 1]);
    CHECK_THAT(fault(), Catch::Contains("one is flipped"));
  }
  SECTION("crossing itself") {
    std::swap(mesh.vertices[0], mesh.vertices[1]);
    CHECK_THAT(fault(), Catch::StartsWith("20: cell 0 is not convex"));
  }
  SECTION("degenerate") {
    mesh.points[4] = mesh.points[3];
    CHECK_THAT(fault(), Catch::StartsWith("20: cell 0 is degenerate"));
  }
  SECTION("no such point") {
    mesh.vertices[9] = 9;
    CHECK_THAT(fault(), Catch::StartsWith("22: cell 2 has point 9, and there are 9"));
  }
  SECTION("in no cell") {
    mesh.points.push_back({5, 5, 0});
    mesh.point_lines.push_back(19);
    CHECK(fault() == "19: point 9 is in no cell; remove it");
  }
  SECTION("hanging: two small cells beside a large one") {
    mesh = {.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0.5, 0}, {2, 0, 0}, {2, 1, 0}}, .vertices = {}};
    mesh.add_cell(std::array{0, 1, 2, 3});
    mesh.add_cell(std::array{1, 5, 4});
    mesh.add_cell(std::array{4, 5, 6});
    mesh.add_cell(std::array{4, 6, 2});
    CHECK_THAT(fault(), Catch::Contains("point 4 hangs in the middle of a side of cell 0"));
  }
  SECTION("three cells at a side") {
    mesh.add_cell(std::array{1, 4, 3});
    CHECK_THAT(fault(), Catch::Contains("a side has two cells at most") || Catch::Contains("clockwise"));
  }
}

}  // namespace
