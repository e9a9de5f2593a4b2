// SPDX-License-Identifier: MIT
#include "lattice/plan/incidence.hpp"

#include <algorithm>
#include <set>

#include "lattice/shapes/hexagon.hpp"
#include "lattice/shapes/triangle.hpp"
#include "tests/catch.hpp"
#include "tests/lattice/plan/systems.hpp"

using namespace delf;
using testing::dense;

namespace {

std::set<Site> offsets(const SystemPattern& system, const Lattice& lattice, Site site) {
  std::set<Site> found;
  for (const Coupling& c : system.equations(lattice, site, 0)) found.insert(c.offset);
  return found;
}

}  // namespace

TEST_CASE("the equation (5.2) of triangles contains the seven sites of Fig. 5.2") {
  const std::set<Site> seven{{-1, -1}, {-1, 0}, {0, -1}, {0, 0}, {0, 1}, {1, 0}, {1, 1}};
  CHECK(offsets(dense(shapes::triangle), Lattice::circle(9, 1), {0, 0}) == seven);
  CHECK(offsets(dense(shapes::triangle), Lattice::interval(9, 1), {5, 4}) == seven);
  CHECK(dense(shapes::triangle).width == 1);
  CHECK(dense(shapes::hexagon).width == 2);
  CHECK(dense(shapes::hexagon).placement == Placement::brick_wall);
}

TEST_CASE("a natural wall's equation has the stencils that are there, a fixed wall has none") {
  const Lattice natural = Lattice::interval(9, 1, Wall::natural, Wall::natural);
  CHECK(offsets(dense(shapes::triangle), natural, {0, 8}) == std::set<Site>{{-1, -1}, {0, -1}, {0, 0}});
  CHECK(offsets(dense(shapes::triangle), Lattice::interval(9, 1), {0, 8}).empty());
}

TEST_CASE("an equation holds only the pairs, components and dependences that it was given") {
  const StencilIncidence family{StencilPattern(shapes::triangle),
                                {{0, 1, 0, 1, Dependence::nonlinear}, {2, 2, 1, 0, Dependence::linear}}};
  const SystemPattern system = system_of(2, {family});
  CHECK(system.width == 0);
  const Lattice circle = Lattice::circle(9, 1);
  CHECK(system.equations(circle, {0, 3}, 0) == std::vector<Coupling>{{{1, 0}, 1, Dependence::nonlinear}});
  CHECK(system.equations(circle, {0, 3}, 1) == std::vector<Coupling>{{{0, 0}, 0, Dependence::linear}});
}
