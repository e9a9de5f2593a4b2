// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "tests/catch.hpp"
#include "tests/verification/experiment.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

double largest(const Row& y) {
  double most = 0;
  for (const double value : y) most = std::max(most, std::abs(value));
  return most;
}

struct Course {
  double growth = 0;    // largest |y| of all rows over that of row 0
  double residual = 0;  // the largest
};

/// 1000 steps from seeded noise at rest.
Course from_noise(Problem p, double mass, double amplitude) {
  p.parameters["theory.mass"] = mass;
  StateRequest request;
  request.name = "noise", request.theory = p.theory, request.values["theory.mass"] = mass,
  request.values["initial.amplitude"] = amplitude;
  request.seed = 7;
  const Row y0 = values(*make_state(request, p.lattice), 0, p.lattice), at_rest(y0.size(), 0.0);
  Simulation simulation(p);
  simulation.start_centred(y0, at_rest);
  Course course;
  while (simulation.newest() < 1000) {
    simulation.step();
    course.growth = std::max(course.growth, largest(newest(simulation, p.lattice)) / largest(y0));
    course.residual = std::max(course.residual, simulation.residual());
  }
  return course;
}

/// From zigzag data y₀ = a (−1)ⁱ, y₁ = 0 under sine-Gordon.
struct Zigzag {
  double growth = 0;             // largest |y|/a of 4000 rows
  double second_difference = 0;  // largest |Z_{j+1} − 2Z_j + Z_{j−1}|/(N a), Z_j = (−1)ʲ Σ_i (−1)ⁱ y_i
  double energy = 0;             // last over first, minus 1
};
Zigzag zigzag(const SchemeName& scheme, int N, double courant) {
  const double a = 1e-3;
  const Lattice lattice = Lattice::circle(N, 40);
  Simulation simulation(problem_for(scheme, "sine-gordon", lattice, courant));
  Row y(at(N));
  const auto Z = [&](std::int64_t j) {
    double sum = 0;
    for (std::size_t i = 0; i < y.size(); ++i) sum += i % 2 ? -y[i] : y[i];
    return j % 2 ? -sum : sum;
  };
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = i % 2 ? -a : a;
  double before = Z(0), now = 0;
  simulation.start({y, Row(y.size(), 0.0)});
  const double energy = simulation.monitors().energy;

  Zigzag result;
  while (simulation.newest() < 4000) {
    simulation.step();
    y = newest(simulation, lattice);
    const double next = Z(simulation.newest());
    result.growth = std::max(result.growth, largest(y) / a);
    result.second_difference = std::max(result.second_difference, std::abs(next - 2 * now + before) / (N * a));
    before = now, now = next;
  }
  result.energy = simulation.monitors().energy / energy - 1;
  return result;
}

}  // namespace

TEST_CASE("Klein-Gordon at mh = 10 and Courant 5 is solved, and bounded over 1000 steps, by both rectangles") {
  for (const SchemeName& scheme : {SchemeName{"rectangle"}, SchemeName{"rectangle-symmetric"}})
    for (const int N : {63, 64}) {
      const Problem p = problem_for(scheme, "klein-gordon", Lattice::circle(N, 10), 5);
      const Course course = from_noise(p, 10 / p.time_step, 0.1);
      CAPTURE(scheme.text(), N, course.growth, course.residual);
      CHECK(course.growth < 5);
      CHECK(course.residual < 1e-14);
    }
}

TEST_CASE("the bound can fail: there the triangle overflows") {
  const Problem p = problem_for({"triangle"}, "klein-gordon", Lattice::circle(64, 10), 5);
  CHECK_THROWS_AS(from_noise(p, 10 / p.time_step, 0.1), NotFinite);
}

TEST_CASE("linear stability about φ = 0: the triangle iff r² + μ/36 ≤ 1, Guo et al. iff r² ≤ 1 + μ/4") {
  const auto growth = [](const SchemeName& scheme, double r, double mh) {
    const Problem p = problem_for(scheme, "sine-gordon", Lattice::circle(64, 10), r);
    return from_noise(p, mh / p.time_step, 1e-6).growth;
  };
  for (const double excess : {-0.003, 0.003}) {
    const double r = 0.98, mh = std::sqrt(36 * (1 + excess - r * r));
    const double g = growth({"triangle"}, r, mh);
    CAPTURE(r, mh, g);
    CHECK((excess < 0 ? g < 10 : g > 100));
    CHECK(growth({"rectangle"}, r, mh) < 10);
  }
  for (const double excess : {-0.003, 0.003}) {
    const double r = 1.05, mh = std::sqrt(4 * (r * r - 1 - excess));
    const double g = growth({"", "guo"}, r, mh);
    CAPTURE(r, mh, g);
    CHECK((excess < 0 ? g < 10 : g > 100));
  }
}

TEST_CASE("the collision by triangles is bounded at Courant 0.98, and not finite at 1.2 within 600 steps") {
  for (const SchemeName& scheme : {SchemeName{"triangle"}, SchemeName{"triangle-vertex"}}) {
    const Lattice lattice = Lattice::circle(255, 40);
    StateRequest request;
    request.name = "mps-collision", request.theory = "sine-gordon";
    const auto state = make_state(request, lattice);
    const Simulation calm = run(problem_for(scheme, "sine-gordon", lattice, 0.98), *state, 1000);
    CAPTURE(scheme.text());
    CHECK(largest(newest(calm, lattice)) < 50);
    CHECK_THROWS_AS(run(problem_for(scheme, "sine-gordon", lattice, 1.2), *state, 600), NotFinite);
    // the same step is no trouble to an implicit scheme
    CHECK_NOTHROW(run(problem_for({"rectangle"}, "sine-gordon", lattice, 1.2), *state, 600));
  }
}

TEST_CASE("for even N the symmetric rectangle has a ghost that its energy does not see: Σ (−1)ⁱ y_i = (−1)ʲ (a + bj)") {
  for (const double courant : {0.125, 0.5, 1.0})
    for (const int N : {64, 128}) {
      const Zigzag ghost = zigzag({"rectangle-symmetric"}, N, courant);
      CAPTURE(courant, N, ghost.growth, ghost.second_difference, ghost.energy);
      CHECK(std::abs(ghost.growth - 3999) < 1e-3);  // a = 1, b = −1
      CHECK(ghost.second_difference < 1e-9);
      CHECK(std::abs(ghost.energy) < 1e-6);  // while the field grew 4000-fold
    }
}

TEST_CASE("for odd N the ghost of the symmetric rectangle stays near N r/π, and (5.10) has none") {
  for (const double courant : {0.125, 0.5, 1.0})
    for (const int N : {63, 127}) {
      const Zigzag capped = zigzag({"rectangle-symmetric"}, N, courant);
      CAPTURE(courant, N, capped.growth, capped.second_difference);
      CHECK(capped.growth > N * courant / 4);
      CHECK(capped.growth < N * courant);
      CHECK(capped.second_difference > 1e-6);
    }
  const Zigzag none = zigzag({"rectangle"}, 64, 0.5);
  CAPTURE(none.growth, none.second_difference);
  CHECK(none.growth < 5);
  CHECK(none.second_difference > 1e-6);
}
