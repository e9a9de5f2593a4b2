// SPDX-License-Identifier: MIT
#include <set>

#include "lattice/shapes/hexagon.hpp"
#include "lattice/shapes/nine_tuple.hpp"
#include "lattice/shapes/rectangle.hpp"
#include "lattice/shapes/six_tuple.hpp"
#include "lattice/stencil.hpp"
#include "lattice/shapes/triangle.hpp"
#include "tests/catch.hpp"

using namespace delf;

static_assert(StencilShape<Offsets<3>>);
static_assert(!StencilShape<Site>);
static_assert(shapes::triangle.size() == 3 && shapes::hexagon.size() == 6 && shapes::nine_tuple.size() == 9);

namespace {

/// How many stencils of the shape touch each site (i = 0 … 7, two rows) of a circle, as a set.
template <StencilShape S>
std::set<std::size_t> touching(const S& shape) {
  const Stencils all(Lattice::circle(8, 1), {StencilPattern(shape)});
  std::set<std::size_t> counts;
  for (int j : {0, 1})
    for (int i = 0; i < 8; ++i) counts.insert(all.touching({j, i}).size());
  return counts;
}

}  // namespace

TEST_CASE("a site is touched by 3 triangles, 4 rectangles, 3 hexagons, 6 six-tuples, 9 nine-tuples") {
  CHECK(touching(shapes::triangle) == std::set<std::size_t>{3});
  CHECK(touching(shapes::rectangle) == std::set<std::size_t>{4});
  CHECK(touching(shapes::hexagon) == std::set<std::size_t>{3});
  CHECK(touching(shapes::six_tuple) == std::set<std::size_t>{6});
  CHECK(touching(shapes::nine_tuple) == std::set<std::size_t>{9});
}

TEST_CASE("the count can fail: hexagons at every site overlap, and six of them touch a site") {
  CHECK(touching(Offsets<6>{shapes::hexagon.vertices}) == std::set<std::size_t>{6});
}

TEST_CASE("vertices are in the papers' order") {
  // Δ = ((i,j), (i,j+1), (i+1,j+1)) and □ = (…, (i+1,j)): (space, time) in the paper, {time, space} here
  CHECK(shapes::triangle.vertices == std::array<Site, 3>{{{0, 0}, {1, 0}, {1, 1}}});
  CHECK(shapes::rectangle.vertices == std::array<Site, 4>{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
  // ◫ = ((j,i−1), (j,i), (j,i+1), (j+1,i+1), (j+1,i), (j+1,i−1))      Tyranowski–Desbrun (113)
  CHECK(shapes::six_tuple.vertices == std::array<Site, 6>{{{0, -1}, {0, 0}, {0, 1}, {1, 1}, {1, 0}, {1, -1}}});
  CHECK(shapes::nine_tuple.vertex(4) == Site{0, 0});
}
