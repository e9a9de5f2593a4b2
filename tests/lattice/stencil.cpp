// SPDX-License-Identifier: MIT
#include "lattice/stencil.hpp"

#include <algorithm>

#include "lattice/error.hpp"
#include "lattice/shapes/hexagon.hpp"
#include "lattice/shapes/rectangle.hpp"
#include "lattice/shapes/triangle.hpp"
#include "tests/catch.hpp"

using namespace delf;

TEST_CASE("the triangles that touch (j, i) are those of Fig. 5.2") {
  const Stencils all(Lattice::circle(9, 1), {StencilPattern(shapes::triangle)});
  const auto found = all.touching({5, 4});
  REQUIRE(found.size() == 3);
  CHECK(found[0].sites == std::vector<Site>{{5, 4}, {6, 4}, {6, 5}});  // as first vertex
  CHECK(found[1].sites == std::vector<Site>{{4, 4}, {5, 4}, {5, 5}});  // as second
  CHECK(found[2].sites == std::vector<Site>{{4, 3}, {5, 3}, {5, 4}});  // as third
  CHECK(found[2].vertex(2) == Site{5, 4});
}

TEST_CASE("a stencil across x = 0 of a circle has sites 0 … N−1 and is one stencil from both sides") {
  const Stencils all(Lattice::circle(9, 1), {StencilPattern(shapes::rectangle)});
  CHECK(all.find(0, {3, 8})->sites == std::vector<Site>{{3, 8}, {4, 8}, {4, 0}, {3, 0}});
  CHECK(*all.find(0, {3, 8}) == *all.find(0, {3, -1}));
}

TEST_CASE("on an interval a stencil lies between the walls, wherever its anchor is") {
  const StencilPattern away(std::vector<Site>{{0, 5}, {1, 6}});
  const Stencils all(Lattice::interval(4, 1), {StencilPattern(shapes::rectangle), away});
  CHECK(all.touching({0, 0}).size() == 2 + 1);
  CHECK_FALSE(all.find(0, {0, 3}));
  CHECK(all.find(1, {0, -5})->sites == std::vector<Site>{{0, 0}, {1, 1}});
  CHECK_FALSE(all.find(1, {0, 0}));
}

TEST_CASE("a stencil longer than its circle touches a site once, though with two vertices") {
  const Stencils all(Lattice::circle(2, 1), {StencilPattern(std::vector<Site>{{0, 0}, {0, 1}, {0, 2}})});
  for (const Stencil& s : all.touching({0, 0})) CHECK(std::ranges::count(s.sites, Site{0, 0}) >= 1);
  CHECK(all.touching({0, 0}).size() == 2);
}

TEST_CASE("a brick wall does not close on an odd circle, and no stencil is no theory") {
  const auto key = [](int sites, std::vector<StencilPattern> families) -> std::string {
    try {
      Stencils(Lattice::circle(sites, 1), std::move(families));
      return "accepted";
    } catch (const BadInput& error) {
      return error.key();
    }
  };
  CHECK(key(255, {StencilPattern(shapes::hexagon)}) == "lattice.sites");
  CHECK(key(256, {StencilPattern(shapes::hexagon)}) == "accepted");
  CHECK(key(255, {StencilPattern(shapes::triangle)}) == "accepted");
  CHECK(key(255, {}) == "lattice.stencil");
  CHECK(key(255, {StencilPattern()}) == "lattice.stencil");
}

TEST_CASE("a pattern of a wall stands in its column alone, in every row, whatever the wall is") {
  for (const Placement placement : {Placement::left_wall, Placement::right_wall}) {
    const StencilPattern pattern({{0, 0}, {1, 0}}, placement);
    const bool is_left = placement == Placement::left_wall;
    for (const Wall left : {Wall::fixed, Wall::natural})
      for (const Wall right : {Wall::fixed, Wall::natural}) {
        const Lattice lattice = Lattice::interval(5, 1, left, right);
        for (int i = 0; i < 5; ++i) {
          const bool there = i == (is_left ? 0 : 4);
          for (const int row : {0, 1}) CHECK(has_stencil(lattice, pattern, {row, i}) == there);
          CHECK(Stencils(lattice, {pattern}).touching({3, i}).size() == (there ? 2 : 0));
        }
      }
    for (const Lattice& lattice : {Lattice::circle(5, 1), Lattice::point()})
      for (int i = 0; i < lattice.sites(); ++i) CHECK_FALSE(has_column(lattice, pattern, i));
  }
}
