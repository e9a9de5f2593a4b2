// SPDX-License-Identifier: MIT
#include "lattice/space/joined_mesh.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/space/mesh_topology.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

using Pairs = std::vector<JoinedParts>;
const Pairs torus{{"left", "right"}, {"bottom", "top"}};

std::string refusal(const Mesh& mesh, const Pairs& pairs) {
  try {
    joined(mesh, pairs);
  } catch (const BadInput& bad) {
    return bad.what();
  }
  return {};
}

}  // namespace

TEST_CASE("a rectangle whose sides are joined is a torus, and an interval a circle") {
  for (const bool quadrilaterals : {false, true}) {
    const Mesh mesh = joined(rectangle_mesh(3, 2, 6, 4, quadrilaterals), torus);
    CHECK(mesh.points.size() == 24);
    CHECK(topology(mesh).euler == 0);
    CHECK(boundary_sides(mesh).empty());
    CHECK(mesh.parts.empty());
    CHECK(shortest_edge(mesh) == Approx(0.5));
    double area = 0;
    for (int c = 0; c < mesh.cells(); ++c) area += measure(mesh, c);
    CHECK(area == Approx(6));
  }
  const Mesh tube = joined(rectangle_mesh(3, 2, 6, 4, false), Pairs{{"left", "right"}});
  CHECK(tube.points.size() == 30);
  CHECK(topology(tube).boundaries == 2);
  REQUIRE(tube.parts.size() == 2);
  CHECK(tube.parts[0].name == "bottom");
  // a side that crosses the seam is as long as the others
  for (const auto& [point, share] : side_shares(tube, tube.parts[1].sides)) CHECK(share == Approx(0.5));
  const Mesh circle = joined(graded_interval(2, 6, 1.3), Pairs{{"left", "right"}});
  CHECK(circle.points.size() == 5);
  CHECK(boundary_points(circle).empty());
}

TEST_CASE("points are matched by their places, whatever their numbers") {
  Mesh mesh = rectangle_mesh(3, 2, 6, 4, true);
  for (auto& p : mesh.vertices) p = 34 - p;  // all points the other way round
  std::ranges::reverse(mesh.points);
  for (auto& part : mesh.parts)
    for (auto& side : part.sides) side = {34 - side[0], 34 - side[1]};
  const Mesh one = joined(mesh, torus);
  CHECK(one.points.size() == 24);
  CHECK(topology(one).euler == 0);
}

TEST_CASE("parts that are no copies of each other are not joined, and say which point is alone") {
  Mesh mesh = rectangle_mesh(3, 2, 6, 4, true);
  CHECK(refusal(mesh, {{"left", "top"}}) ==
        "boundary.left = periodic:top: point 0 of left, at (0, 0), has no partner on top, at (1.5, 1); mesh both parts "
        "alike, one a translation of the other");
  CHECK(refusal(mesh, {{"left", "outlet"}}).ends_with("has no part outlet; name one of its boundary's parts"));
  CHECK(refusal(mesh, {{"left", "left"}}).ends_with("the two parts lie at one place; name the one on the other side"));
  mesh.points[13][1] += 0.1;  // x = 3
  CHECK(
      refusal(mesh, {{"left", "right"}}).starts_with("boundary.left = periodic:right: point 7 of left, at (0, 0.5), "));
  CHECK(refusal(rectangle_mesh(3, 2, 2, 4, true), {{"left", "right"}})
            .ends_with("take three cells at least from one part to the other"));
  CHECK(refusal(rectangle_mesh(3, 2, 1, 4, false), {{"left", "right"}})
            .ends_with("take three cells at least from one part to the other"));
  // a point more on one side
  Mesh finer{
      .points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0}, {1, 1, 0}, {0, 1, 0}, {3, 0.5, 0}},
      .vertices = {}};
  finer.add_cell(std::array{0, 1, 6, 7}), finer.add_cell(std::array{1, 2, 5, 6});
  finer.add_cell(std::array{2, 3, 8}), finer.add_cell(std::array{2, 8, 5}), finer.add_cell(std::array{8, 4, 5});
  finer.parts = {{"left", {{7, 0}}}, {"right", {{3, 8}, {8, 4}}}};
  CHECK(refusal(finer, {{"left", "right"}})
            .starts_with(
                "boundary.left = periodic:right: point 8 of right, at (3, 0.5), has no partner on left, at (0, 0.5)"));
}
