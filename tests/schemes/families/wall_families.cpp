// SPDX-License-Identifier: MIT
#include "schemes/families/wall_families.hpp"

#include <string>
#include <vector>

#include "jets/tables/triangle_jet.hpp"
#include "lattice/stencil.hpp"
#include "schemes/scheme.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr Wall fixed = Wall::fixed, natural = Wall::natural;

/// Its natural condition is −φ_x + 0.1 φ_t = 0.
struct Skew {
  auto operator()(const auto& j) const {
    return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) + 0.1 * j.phi_t * j.phi_x;
  }
};

std::vector<int> columns_with_terms(const Lattice& lattice, const std::string& stencil) {
  std::vector<int> columns;
  for (const auto& family : theory_named(problem_of("sine-gordon"))->at_walls(stencil, lattice))
    for (int i = 0; i < lattice.sites(); ++i)
      if (has_stencil(lattice, family->pattern(), {3, i})) columns.push_back(i);
  return columns;
}

}  // namespace

TEST_CASE("terms of natural walls stand at these alone: not at fixed walls, round a circle or on a point") {
  for (const char* stencil : {"triangle", "triangle-vertex"}) {
    const auto between = [&](Wall left, Wall right) {
      return columns_with_terms(Lattice::interval(8, 1, left, right), stencil);
    };
    CHECK(between(fixed, fixed).empty());
    CHECK(between(natural, fixed) == std::vector{0});
    CHECK(between(fixed, natural) == std::vector{7});
    CHECK(between(natural, natural) == std::vector{0, 7});
    CHECK(columns_with_terms(Lattice::circle(8, 1), stencil).empty());
    CHECK(columns_with_terms(Lattice::point(), stencil).empty());
  }
  CHECK(columns_with_terms(Lattice::interval(8, 1, natural, natural), "rectangle").empty());
}

TEST_CASE("a scheme in code and one by name have the same terms at walls") {
  const Lattice lattice = Lattice::interval(8, 1, natural, natural);
  CHECK(Scheme{triangle, SineGordon{}}.on(lattice, 0.05).system().families().size() == 3);
  CHECK(Scheme{triangle, SineGordon{}}.on(Lattice::circle(8, 1), 0.05).system().families().size() == 1);
  Problem p = problem_of("sine-gordon");
  p.stencil = "triangle", p.lattice = lattice, p.time_step = 0.05;
  CHECK(Simulation(p).evolution().system().families().size() == 3);
}

TEST_CASE("a density whose natural condition is not a level field is refused where a wall needs a term") {
  const auto key = [](const Lattice& lattice) {
    return refused_key([&] { Scheme{triangle, Skew{}}.on(lattice, 0.05); });
  };
  CHECK(key(Lattice::interval(8, 1, natural, fixed)) == "lattice.stencil");
  CHECK(key(Lattice::interval(8, 1, fixed, fixed)) == "accepted");
  CHECK(key(Lattice::circle(8, 1)) == "accepted");
  const Lattice lattice = Lattice::interval(8, 1, natural, fixed);
  CHECK(refused_key([&] { Scheme{triangle, SineGordon{}}.on(lattice, 0.05); }) == "accepted");
}

TEST_CASE("natural walls with a term take densities whose form says that phi_x = 0 there, and no others") {
  const auto key = [](const std::string& density) {
    Problem p;
    p.theory = "text", p.stencil = "triangle", p.time_step = 0.05;
    p.lattice = Lattice::interval(8, 1, natural, fixed);
    p.parameters["theory.density"] = "0.5*phi_t^2 - (" + density + ")";
    return refused_key([&] { Simulation{p}; });
  };
  for (const char* level : {"cosh(phi_x)", "sqrt(1 + phi_x^2)", "(phi_x - phi)*(phi_x + phi)", "exp(phi_x) - phi_x",
                            "phi_x*sin(phi_x) + cos(phi)*phi_x^4", "cos(x)*phi_x^2"})
    CHECK(key(level) == "accepted");
  for (const char* other : {"exp(phi_x)", "phi_x^2 - phi_x", "phi_x^2 + phi*phi_x^3*phi_x^2 + phi*phi_x",
                            "phi_x^2 + 0.1*phi_t*phi_x", "phi_x^2 + x*phi_x"})
    CHECK(key(other) == "lattice.stencil");
}

TEST_CASE("triangles between natural walls step whole rows, of sites that are all solved at the next row") {
  for (const char* stencil : {"triangle", "triangle-vertex"})
    for (const int N : {5, 8, 33, 64}) {
      Problem p = problem_of("sine-gordon");
      p.stencil = stencil, p.lattice = Lattice::interval(N, 0.1 * (N - 1), natural, natural), p.time_step = 0.05;
      Simulation simulation(p);
      const Evolution& evolution = simulation.evolution();
      CHECK(evolution.plan().exceptional.empty());
      REQUIRE(evolution.stepper().layout());
      Random random(7);
      simulation.start(random_rows(random, 2, N, 2));
      for (int n = 0; n < 20; ++n) {
        simulation.step();
        CAPTURE(stencil, N, n);
        // the equations as the system has them, one site at a time, and as the rows have them
        CHECK(equation_defect(evolution, window_of(evolution)) < 1e-13);
        CHECK(evolution.stepper().residual() < 1e-13);
      }
    }
}
