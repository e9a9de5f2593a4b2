// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>

#include "lattice/error.hpp"
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

TEST_CASE("a gas of kinks and antikinks solves the equation up to tails, from vacuum to vacuum, and moves as they do") {
  for (const std::string theory : {"phi4", "double-sine-gordon"}) {
    INFO(theory);
    StateRequest r = pair_of(theory, 0);
    r.name = "kink-gas";
    r.values["initial.kinks"] = 4.0;
    r.values["initial.speed"] = 0.6;
    const Lattice lattice = Lattice::circle(800, 160);
    const auto gas = make_state(r, lattice);
    CHECK(misses(theory, *gas) < 1e-6);
    CHECK(gas->winding() == 0);
    CHECK(at(*gas, 0, 0).phi == Approx(at(*gas, 0, 160).phi).margin(1e-9));
    // each passes the middle between the vacua once
    const double middle = theory == "phi4" ? 0 : 4 * std::atan(1);
    int crossings = 0;
    for (double x = 0.05; x < 160; x += 0.1)
      crossings += (at(*gas, 0, x).phi < middle) != (at(*gas, 0, x + 0.1).phi < middle);
    CHECK(crossings == 4);
    // φ_t and φ_x against differences
    constexpr double d = 1e-5;
    for (double x = 1; x < 160; x += 1.7) {
      const FieldPoint p = at(*gas, 0, x);
      CHECK(p.phi_t == Approx((at(*gas, d, x).phi - at(*gas, -d, x).phi) / (2 * d)).margin(1e-8));
      CHECK(p.phi_x == Approx((at(*gas, 0, x + d).phi - at(*gas, 0, x - d).phi) / (2 * d)).margin(1e-8));
    }
    // another seed, another gas
    r.seed = 2;
    CHECK(at(*make_state(r, lattice), 0, 20).phi_x != at(*gas, 0, 20).phi_x);
    for (const double wrong : {3.0, 0.0, 2.5, 100.0}) {
      r.values["initial.kinks"] = wrong;
      CHECK_THROWS_AS(make_state(r, lattice), BadInput);
    }
  }
}
