// SPDX-License-Identifier: MIT
#include "lattice/plan/quotient.hpp"

#include "lattice/shapes/hexagon.hpp"
#include "lattice/shapes/nine_tuple.hpp"
#include "lattice/shapes/triangle.hpp"
#include "tests/catch.hpp"
#include "tests/lattice/plan/systems.hpp"

using namespace delf;
using testing::dense;

TEST_CASE("a circle repeats one site, or two sites and two rows of a brick wall") {
  const Quotient triangles = Quotient::of_circle(Lattice::circle(255, 1), dense(shapes::triangle));
  CHECK(triangles.nodes() == 1);
  CHECK(triangles.edges.size() == 9);  // 3 × 3 entries of the Hessian, each once
  const Quotient bricks = Quotient::of_circle(Lattice::circle(256, 1), dense(shapes::hexagon));
  CHECK(bricks.nodes() == 4);
  CHECK(bricks.edges.size() == 2 * 36);
}

TEST_CASE("the middle of an interval is the cell of a circle, whatever the walls are") {
  const auto same = [](const Quotient& a, const Quotient& b) {
    if (a.nodes() != b.nodes() || a.edges.size() != b.edges.size()) return false;
    for (std::size_t n = 0; n < a.edges.size(); ++n)
      if (a.edges[n].unknown != b.edges[n].unknown || a.edges[n].time != b.edges[n].time ||
          a.edges[n].space != b.edges[n].space)
        return false;
    return true;
  };
  const Lattice circle = Lattice::circle(256, 1), interval = Lattice::interval(256, 1, Wall::natural, Wall::fixed);
  for (const SystemPattern& system : {dense(shapes::triangle), dense(shapes::nine_tuple), dense(shapes::hexagon)}) {
    for (const int sites : {9, 12, 13, 14, 255})
      CHECK(same(Quotient::of_interval(interval, system, sites).middle(), Quotient::of_circle(circle, system)));
    // it can differ: three sites have no middle that no wall is near
    if (system.width == 2)
      CHECK_FALSE(same(Quotient::of_interval(interval, system, 3).middle(), Quotient::of_circle(circle, system)));
  }
}

TEST_CASE("the centre keeps its place in its period as the interval grows by periods") {
  const SystemPattern system = dense(shapes::nine_tuple);
  for (int sites = 9; sites < 30; ++sites) {
    const Quotient q = Quotient::of_interval(Lattice::interval(100, 1), system, sites);
    CHECK(q.centre() % q.period == 0);
    CHECK(q.centre() >= 2 * system.width);
    CHECK(q.sites - q.centre() > 2 * system.width);
  }
}
