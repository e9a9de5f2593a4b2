// SPDX-License-Identifier: MIT
#include "schemes/stability/constraint_ghost.hpp"

#include <numbers>
#include <string>

#include "jets/tables/rectangle_jet.hpp"
#include "jets/tables/triangle_jet.hpp"
#include "schemes/scheme.hpp"
#include "schemes/theories/wave_map.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

Problem wave_map_on(const std::string& stencil, const Lattice& lattice, double courant) {
  Problem p;
  p.theory = "wave-map", p.stencil = stencil, p.lattice = lattice, p.time_step = courant * lattice.space_step();
  return p;
}

}  // namespace

TEST_CASE("the symmetric rectangle under a constraint has the ghost (-1)^(i+j), whatever N, h/k and the walls are") {
  for (const Lattice& lattice : {Lattice::circle(32, 6), Lattice::circle(31, 6), Lattice::interval(32, 6)})
    for (const double courant : {0.1, 0.125, 0.32, 0.5, 0.7, 0.9, 1.0, 1.2}) {
      CAPTURE(lattice.sites(), courant);
      const Simulation simulation(wave_map_on("rectangle-symmetric", lattice, courant));
      const auto ghost = ghost_under_constraint(simulation.evolution().system());
      REQUIRE(ghost);
      CHECK(ghost->theta == Approx(std::numbers::pi));
      CHECK(ghost->z == -1);
      CHECK(contains(in_words_under_constraint(*ghost), "theta = pi, z = -1"));
    }
}

TEST_CASE("other stencils have none under a constraint, and without one a ghost is none of this sort") {
  for (const char* stencil : {"triangle-vertex", "rectangle"})
    for (const double courant : {0.1, 0.32, 0.5, 0.7, 0.9}) {
      const Simulation simulation(wave_map_on(stencil, Lattice::circle(32, 6), courant));
      CAPTURE(stencil, courant);
      CHECK_FALSE(ghost_under_constraint(simulation.evolution().system()));
    }
  // leapfrog at its stability limit h = k: the roots meet at z = -1, but not below it
  CHECK_FALSE(ghost_under_constraint(Scheme{triangle_vertex, WaveMap{}}.on(Lattice::circle(32, 32), 1).system()));
  Problem p = wave_map_on("rectangle-symmetric", Lattice::circle(32, 6), 0.5);
  p.theory = "wave";
  CHECK_FALSE(ghost_under_constraint(Simulation(p).evolution().system()));
}

TEST_CASE("a plan names the ghost under a constraint") {
  const auto report = [](const char* stencil) {
    return Simulation(wave_map_on(stencil, Lattice::circle(32, 6), 0.5)).plan_report();
  };
  CHECK(contains(report("rectangle-symmetric"), "ghost        waves near theta = pi, z = -1"));
  CHECK_FALSE(contains(report("rectangle"), "ghost"));
}
