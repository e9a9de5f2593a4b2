// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>

#include "schemes/states/state_registry.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

StateRequest pair_of(const std::string& theory, double separation) {
  StateRequest r;
  r.name = "kink-antikink";
  r.theory = theory;
  r.values["initial.speed"] = 0.4;
  r.values["initial.separation"] = separation;
  r.values["theory.lambda"] = 2.0;
  r.values["theory.mass"] = 1.0;
  return r;
}

// −N′(φ) at mass 1 and λ = 2
double force(const std::string& theory, double phi) {
  return theory == "phi4" ? 2 * phi * (phi * phi - 1) : std::sin(phi) + 2 * std::sin(2 * phi);
}

FieldPoint at(const State& state, double t, double x) {
  FieldPoint p;
  state.at(t, x, std::span(&p, 1));
  return p;
}

// The largest |φ_tt − φ_xx − N′(φ)| at t = 0, by central differences of order four.
double misses(const std::string& theory, const State& state) {
  constexpr double d = 0.01;
  double largest = 0;
  for (double x = 5; x < 75; x += 0.37) {
    const auto second = [&](auto f) { return (-f(2) + 16 * f(1) - 30 * f(0) + 16 * f(-1) - f(-2)) / (12 * d * d); };
    const double tt = second([&](int n) { return at(state, n * d, x).phi; });
    const double xx = second([&](int n) { return at(state, 0, x + n * d).phi; });
    largest = std::max(largest, std::abs(tt - xx + force(theory, at(state, 0, x).phi)));
  }
  return largest;
}

}  // namespace

TEST_CASE("a kink and an antikink of phi4 and double sine-Gordon solve the equation up to each other's tails") {
  for (const std::string theory : {"phi4", "double-sine-gordon"}) {
    INFO(theory);
    const Lattice lattice = Lattice::circle(800, 80);
    const auto far = make_state(pair_of(theory, 24), lattice), near = make_state(pair_of(theory, 3), lattice);
    CHECK(misses(theory, *far) < 1e-6);
    CHECK(misses(theory, *near) > 1e-3);  // the check can fail
    CHECK_FALSE(far->exact());
    CHECK(far->winding() == 0);
    // from one vacuum to the next and back
    const double upper = theory == "phi4" ? 1 : 8 * std::atan(1), lower = theory == "phi4" ? -1 : 0;
    CHECK(at(*far, 0, 40).phi == Approx(upper).margin(1e-6));
    CHECK(at(*far, 0, 5).phi == Approx(lower).margin(1e-6));
    CHECK(at(*far, 0, 75).phi == Approx(lower).margin(1e-6));
    // they come together
    CHECK(at(*far, 5, 28).phi < at(*far, 0, 28).phi);
    CHECK(at(*far, 0, 29).phi_t == Approx((at(*far, 1e-5, 29).phi - at(*far, -1e-5, 29).phi) / 2e-5).epsilon(1e-6));
    CHECK(at(*far, 0, 29).phi_x ==
          Approx((at(*far, 0, 29 + 1e-5).phi - at(*far, 0, 29 - 1e-5).phi) / 2e-5).epsilon(1e-6));
  }
}
