// SPDX-License-Identifier: MIT
#include "schemes/stability/linear_stability.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "schemes/families/damped_leapfrog.hpp"
#include "schemes/stability/dispersion.hpp"
#include "schemes/stability/stable_set.hpp"
#include "schemes/theories/klein_gordon.hpp"
#include "schemes/verify/wrong_sign.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;
using std::numbers::pi;

namespace {

Problem stencil(const std::string& name) {
  Problem p;
  p.stencil = name;
  return p;
}
Problem method(const std::string& name) {
  Problem p;
  p.method = name;
  return p;
}
Problem element(int degree_time, int degree_space, const std::string& quadrature) {
  Problem p = method("spacetime");
  p.parameters["scheme.degree_time"] = degree_time, p.parameters["scheme.degree_space"] = degree_space,
  p.parameters["scheme.quadrature"] = quadrature;
  return p;
}

/// Klein-Gordon at a Courant number and an mh, with k = 1.
LatticeSystem klein_gordon(Problem p, double courant, double mh) {
  p.theory = "klein-gordon", p.parameters["theory.mass"] = mh / courant, p.time_step = courant;
  p.lattice = Lattice::circle(16, 16);
  return Simulation(completed(p)).evolution().system();
}
StabilityVerdict verdict(const Problem& p, double courant, double mh) {
  return linear_stability(klein_gordon(p, courant, mh));
}

std::vector<StableInterval> courants(const Problem& p, double mh, double most = 2, int samples = 40) {
  return stable_courants([&](double courant) { return klein_gordon(p, courant, mh); }, most, {samples});
}
std::vector<StableInterval> masses(const Problem& p, double courant, double most, int samples = 80) {
  return stable_set([&](double mh) { return klein_gordon(p, courant, mh); }, 0, most, {samples});
}

/// Stable up to `limit`, which is found to 1e-6, and not a millionth beyond it.
void stable_up_to(const Problem& p, double mh, double limit) {
  CAPTURE(p.stencil, p.method, mh, limit);
  const auto set = courants(p, mh);
  REQUIRE(set.size() == 1);
  CHECK(set[0].from == 0);
  CHECK(std::abs(set[0].to - limit) < 1e-6);
  CHECK(verdict(p, limit * (1 - 1e-6), mh).stable);
  const StabilityVerdict beyond = verdict(p, limit * (1 + 1e-6), mh);
  CHECK_FALSE(beyond.stable);
  CHECK(beyond.amplification > 1 + 1e-4);  // it leaves the circle like a square root
}

}  // namespace

TEST_CASE("the triangle (5.8) is stable iff r^2 + mu/36 is at most 1, and at its first vertex iff r^2 + mu/4 is") {
  for (const double mh : {0.0, 0.7, 1.5}) {
    stable_up_to(stencil("triangle"), mh, std::sqrt(1 - mh * mh / 36));
    stable_up_to(stencil("triangle-vertex"), mh, std::sqrt(1 - mh * mh / 4));
  }
}

TEST_CASE("Guo et al. (5.15) is stable iff r^2 is at most 1 + mu/4") {
  for (const double mh : {0.0, 0.7, 2.0}) stable_up_to(method("guo"), mh, std::sqrt(1 + mh * mh / 4));
}

TEST_CASE(
    "the rectangles (5.10), (5.12) and Vu-Quoc-Li (5.14) are always stable, and their frequencies those of theory") {
  // tan²(ωh/2), with s = sin²(θ/2)
  const auto rectangle = [](double r, double mu, double s) { return r * r * s + mu * (1 - s) / 4; };
  const auto symmetric = [](double r, double mu, double s) { return r * r * s / (1 - s) + mu / 4; };
  const auto comparator = [](double r, double mu, double s) { return r * r * s + mu / 4; };
  const auto check = [](const Problem& p, auto tangent_squared) {
    CAPTURE(p.stencil, p.method);
    for (const double mh : {0.0, 0.5, 3.0}) {
      const auto set = courants(p, mh, 4);
      REQUIRE(set.size() == 1);
      CHECK(set[0].from == 0);
      CHECK(set[0].to == 4);
      for (const double r : {0.3, 1.0, 2.5}) {
        const Symbol symbol(klein_gordon(p, r, mh));
        for (const double theta : {0.2, 1.4, 3.0}) {
          const double s = std::pow(std::sin(theta / 2), 2), tangent = std::sqrt(tangent_squared(r, mh * mh, s));
          // z = e^{±iωh} = (1 ± i tan)/(1 ∓ i tan)
          const std::complex<double> z = std::complex(1.0, tangent) / std::complex(1.0, -tangent);
          const auto roots = symbol.roots(theta);
          REQUIRE(roots.size() == 2);
          for (const auto& root : roots) CHECK(std::min(std::abs(root - z), std::abs(root - std::conj(z))) < 1e-12);
          CHECK(std::abs(roots[0] + roots[1] - 2 * z.real()) < 1e-12);
        }
      }
    }
  };
  check(stencil("rectangle"), rectangle);
  check(stencil("rectangle-symmetric"), symmetric);
  check(method("vu-quoc-li"), comparator);
}

// At θ = 0, where the hexagon's two kinds of sites oscillate against each other, its 2×2 determinant is by hand, with
// u = z + 1/z,
//
//   (2 − u)(2 + u + r²(u − 2)) − (μ/18)(20 + 16u + 5u² + (9/2) r²(u² − 4)),
//
// whose two roots u are real as long as μ ≤ 12/(2 + 3r²); for r² > 2 they meet again at μ = 12/(3r² − 2).
TEST_CASE("the hexagon's tongues begin where its determinant at theta = 0 says") {
  const auto discriminant = [](double r, double mu) {
    const double R = r * r, a = -(1 + R) - mu / 18 * (5 + 4.5 * R), b = 4 * R - mu / 18 * 16,
                 c = 4 - 4 * R - mu / 18 * (20 - 18 * R);
    return b * b - 4 * a * c;
  };
  const Problem hexagon = stencil("hexagon");
  for (const double r : {0.25, 0.5, 0.9}) {
    const double limit = std::sqrt(12 / (2 + 3 * r * r));
    CAPTURE(r, limit);
    CHECK(std::abs(discriminant(r, limit * limit)) < 1e-12);
    const auto set = masses(hexagon, r, 4, 40);
    REQUIRE(set.size() == 1);
    CHECK(std::abs(set[0].to - limit) < 1e-6);
    CHECK(verdict(hexagon, r, limit - 1e-6).stable);
    CHECK_FALSE(verdict(hexagon, r, limit + 1e-6).stable);
  }
  const double again = std::sqrt(12 / (3 * 4. - 2));
  CHECK(std::abs(discriminant(2, again * again)) < 1e-12);
  const auto beyond = masses(hexagon, 2, 4, 40);
  REQUIRE(beyond.size() == 1);
  CHECK(std::abs(beyond[0].from - again) < 1e-6);
}

TEST_CASE("the hexagon's stable Courant numbers are no interval") {
  const Problem hexagon = stencil("hexagon");
  const auto set = courants(hexagon, 1, 3);
  REQUIRE(set.size() == 2);
  CHECK(set[0].from == 0);
  CHECK(set[0].to < std::sqrt(2));
  CHECK(std::abs(set[1].from - std::sqrt(14. / 3)) < 1e-6);  // 12/(3r² − 2) = 1
  CHECK_FALSE(verdict(hexagon, 0.5 * (set[0].to + set[1].from), 1).stable);
  CHECK_FALSE(verdict(hexagon, set[0].to + 1e-6, 1).stable);
  CHECK(verdict(hexagon, set[0].to - 1e-6, 1).stable);
}

TEST_CASE("the even-N ghost of the symmetric rectangle is found and named, and others have none") {
  for (const double mh : {0.0, 0.4}) {
    const StabilityVerdict ghostly = verdict(stencil("rectangle-symmetric"), 0.5, mh);
    CHECK(ghostly.stable);
    CHECK_FALSE(ghostly.bounded());
    REQUIRE(ghostly.ghosts.size() == 1);
    const Ghost& ghost = ghostly.ghosts[0];
    CHECK(ghost.theta == Approx(pi).epsilon(1e-12));
    CHECK(std::abs(ghost.z + 1.0) < 1e-7);
    CHECK(ghost.multiplicity == 2);
    CHECK(ghost.modes == 1);
    CHECK(ghost.words ==
          "theta = pi (even N only), z = -1: double root with one mode, (-1)^(i+j) (a + b j), grows linearly");
    for (const char* other : {"triangle", "triangle-vertex", "rectangle", "hexagon", "six-tuple"}) {
      CAPTURE(other, mh);
      const StabilityVerdict none = verdict(stencil(other), 0.5, mh);
      CHECK(none.bounded());
      CHECK(none.drift == (mh == 0));  // y = a + b j is what the wave equation itself does
    }
  }
}

TEST_CASE("a step at its very limit is stable and has a ghost") {
  const StabilityVerdict limit = verdict(stencil("triangle-vertex"), 1, 0);
  CHECK(limit.stable);
  REQUIRE(limit.ghosts.size() == 1);
  CHECK(contains(limit.ghosts[0].words, "theta = pi (even N only), z = -1"));
  CHECK_FALSE(verdict(stencil("triangle-vertex"), 1 + 1e-9, 0).stable);
}

TEST_CASE("two fields that do not know of each other have double roots without ghosts, and twice the ghost") {
  Problem p;
  p.theory = "coupled-sine-gordon", p.parameters["theory.mass"] = 0.8, p.parameters["theory.lambda"] = 0;
  p.lattice = Lattice::circle(8, 8), p.time_step = 0.5;
  p.stencil = "rectangle";
  CHECK(linear_stability(Simulation(p).evolution().system()).bounded());
  p.stencil = "rectangle-symmetric";
  const StabilityVerdict twice = linear_stability(Simulation(p).evolution().system());
  REQUIRE(twice.ghosts.size() == 1);
  CHECK(twice.ghosts[0].multiplicity == 4);
  CHECK(twice.ghosts[0].modes == 2);
}

TEST_CASE("friction has its roots inside the circle, where theory has them") {
  const double r = 0.5, damping = 0.1 * r / 2;  // γh/2
  const StabilityVerdict damped = verdict(method("damped"), r, 0.3);
  CHECK(damped.bounded());
  CHECK(damped.amplification < 1);
  CHECK(damped.amplification == Approx(std::sqrt((1 - damping) / (1 + damping))).epsilon(1e-12));
}

TEST_CASE("the check can fail: a planted wrong sign takes the roots from the circle") {
  for (const char* name : {"triangle", "rectangle", "rectangle-symmetric", "hexagon"}) {
    CAPTURE(name);
    const LatticeSystem right = klein_gordon(stencil(name), 0.5, 0.5);
    CHECK(linear_stability(right).stable);
    CHECK(linear_stability(right).amplification == 1);
    for (int value = 0; value < 3; ++value) {
      CAPTURE(value);
      const LatticeSystem wrong(right.lattice(), {std::make_shared<WrongSign>(right.families()[0], value)},
                                right.time_step());
      // Away from the circle: outside, or (as the mirror image of that in time) inside.
      CHECK(std::abs(linear_stability(wrong).amplification - 1) > 1e-3);
    }
  }
}

TEST_CASE("a state on top of the potential is unstable, with the worst wave number found") {
  Problem p;
  p.theory = "sine-gordon", p.lattice = Lattice::circle(8, 8), p.time_step = 0.5, p.stencil = "rectangle";
  const LatticeSystem system = Simulation(p).evolution().system();
  CHECK(linear_stability(system).stable);
  const StabilityVerdict top = linear_stability(system, pi);
  CHECK_FALSE(top.stable);
  CHECK(top.worst_theta < 1e-3);
  CHECK(top.amplification == Approx(1.25 / 0.75).epsilon(1e-9));
}

TEST_CASE("mechanics: the midpoint rule is always stable, the other two below omega h = 2") {
  const auto limit = [](const char* name) {
    return stable_set(
        [&](double h) {
          Problem p = stencil(name);
          p.theory = "klein-gordon", p.lattice = Lattice::point(), p.time_step = h;
          return Simulation(p).evolution().system();
        },
        0, 5, {50});
  };
  CHECK(limit("midpoint").back().to == 5);
  for (const char* name : {"trapezoidal", "vertex"}) {
    const auto set = limit(name);
    REQUIRE(set.size() == 1);
    CHECK(std::abs(set[0].to - 2) < 1e-6);
  }
}

TEST_CASE("the dispersion relation: an arc tangent for the rectangle, and of the order that a scheme has") {
  const double mass = 0.6, r = 0.5;
  const auto relation = [&](const Problem& p) { return dispersion(Symbol(klein_gordon(p, r, mass * r)), mass, 25); };
  const auto points = relation(stencil("rectangle"));
  REQUIRE(points.size() == 25);
  CHECK(points.back().wave_number == Approx(pi));
  for (const DispersionPoint& point : points) {
    const double s = std::pow(std::sin(point.wave_number / 2), 2);
    CHECK(point.exact == Approx(r * std::hypot(mass, point.wave_number)));
    CHECK(point.numerical ==
          Approx(2 * std::atan(std::sqrt(r * r * s + mass * mass * r * r * (1 - s) / 4))).epsilon(1e-11));
    CHECK(point.amplification == Approx(1).epsilon(1e-11));
  }
  // At eight points a wave length, a quarter of the way: elements of higher degree are nearer to the exact relation.
  const auto error = [&](const Problem& p) {
    double worst = 0;
    for (const DispersionPoint& point : relation(p))
      if (point.wave_number < pi / 4 + 1e-9) worst = std::max(worst, std::abs(point.numerical / point.exact - 1));
    return worst;
  };
  CHECK(error(stencil("triangle")) < 0.07);
  CHECK(error(stencil("hexagon")) < 0.12);
  CHECK(error(stencil("rectangle")) > 1e-2);
  CHECK(error(element(2, 2, "gauss")) < 2e-3);
  CHECK(error(element(2, 3, "gauss")) < 2e-4);
  CHECK(relation(element(2, 3, "gauss")).back().wave_number == Approx(3 * pi));
}
