// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "jets/tables/rectangle_jet.hpp"
#include "tests/catch.hpp"
#include "tests/verification/by_name.hpp"

using namespace delf;
using namespace delf::testing;
using From = ByName::From;

namespace {

constexpr const char* charge_stencils[] = {"triangle", "rectangle", "rectangle-symmetric", "hexagon", "six-tuple"};

/// Two breathers of frequency 0.6, side by side in the fibre.
ByName breathers(const std::string& stencil, int N) {
  Problem p;
  p.theory = "coupled-sine-gordon", p.stencil = stencil, p.lattice = Lattice::circle(N, 40);
  p.time_step = 0.5 * p.lattice.space_step();
  StateRequest request;
  request.name = "coupled-breathers", request.values["initial.frequency"] = 0.6;
  return {p, request};
}

/// One period of the wave on a circle of length 6: m = 1, λ = ½, h = k/2.
ByName charged(const char* state, const std::string& stencil, int N, From from) {
  Problem p;
  p.theory = "complex-klein-gordon", p.parameters["theory.lambda"] = 0.5, p.stencil = stencil;
  p.lattice = Lattice::circle(N, state == std::string("charged-wave") ? 6 : 20);
  p.time_step = 0.5 * p.lattice.space_step();
  StateRequest request;
  request.name = state;
  if (request.name == "charged-packet")
    request.values["initial.amplitude"] = 1, request.values["initial.width"] = 2,
    request.values["initial.wavenumber"] = 2;
  return {p, request, from};
}

/// ComplexKleinGordon with a mass that differs between the two fields.
struct UnevenMass {
  static constexpr int components = 2;
  double excess = 0.3;
  auto operator()(const auto& j) const {
    const auto squared = [](const auto& z) { return z[0] * z[0] + z[1] * z[1]; };
    const auto s = squared(j.phi);
    return 0.5 * (squared(j.phi_t) - squared(j.phi_x)) - 0.5 * s - 0.125 * (s * s) -
           (0.5 * excess) * (j.phi[0] * j.phi[0]);
  }
};

bool second(double order) { return std::abs(order - 2) < 0.1; }

}  // namespace

TEST_CASE("two coupled fields are followed to second order") {
  for (const char* stencil : {"rectangle-symmetric", "triangle"}) {
    const auto error = [&](int N) {
      ByName run = breathers(stencil, N);
      REQUIRE(run.state().exact());
      return run.to(12 * N / 20).error();  // t = 12
    };
    const double e1 = error(160), e2 = error(320), e3 = error(640);
    const double coarse = std::log2(e1 / e2), fine = std::log2(e2 / e3);
    CAPTURE(stencil, e1, e2, e3, coarse, fine);
    CHECK(second(coarse));
    CHECK(second(fine));
  }
}

TEST_CASE("a charged wave is followed to second order, at an amplitude where the nonlinear term counts") {
  for (const char* stencil : charge_stencils) {
    const auto error = [&](int N) { return charged("charged-wave", stencil, N, From::exact).to(N).error(); };  // t = 3
    const double e1 = error(64), e2 = error(128), e3 = error(256);
    const double coarse = std::log2(e1 / e2), fine = std::log2(e2 / e3);
    CAPTURE(stencil, e1, e2, e3, coarse, fine);
    CHECK(second(coarse));
    CHECK(second(fine));
  }
}

TEST_CASE("the check can fail: a wave of another coupling is not approached") {
  const auto error = [](int N) {
    Problem p;
    p.theory = "complex-klein-gordon", p.parameters["theory.lambda"] = 0.5, p.stencil = "rectangle";
    p.lattice = Lattice::circle(N, 6), p.time_step = 0.5 * p.lattice.space_step();
    StateRequest request;
    request.name = "charged-wave", request.theory = p.theory, request.values["theory.lambda"] = 0.6;  // ω of λ = 0.6
    const auto wave = make_state(request, p.lattice);
    Simulation simulation(p);
    const auto row = [&](int n) {
      std::vector<double> y(2 * N);
      wave->values(n * p.time_step, p.lattice, y);
      return y;
    };
    simulation.start({row(0), row(1)});
    while (simulation.newest() < N) simulation.step();
    std::vector<double> y(2 * N);
    simulation.copy_row(0, y);
    const std::vector<double> exact = row(N);
    double most = 0;
    for (std::size_t n = 0; n < y.size(); ++n) most = std::max(most, std::abs(y[n] - exact[n]));
    return most;
  };
  const double order = std::log2(error(128) / error(256));
  CHECK_FALSE(second(order));
}

struct Charge {
  double first, drift, moved;  ///< drift: relative; moved: the largest change of a value
};

Charge charge_over_2000_steps(const char* state, const char* stencil) {
  ByName run = charged(state, stencil, 64, state == std::string("charged-wave") ? From::exact : From::centred);
  REQUIRE(run.simulation().conserved_names() == std::vector<std::string>{"charge_u1"});
  Charge charge{run.simulation().monitors().conserved.at(0), 0, 0};
  const std::vector<double> y0 = run.newest();
  for (int n = 10; n <= 2000; n += 10) {
    charge.drift =
        std::max(charge.drift, std::abs(run.to(n).simulation().monitors().conserved.at(0) / charge.first - 1));
    const std::vector<double> y = run.newest();
    for (std::size_t i = 0; i < y.size(); ++i)
      charge.moved = std::max(charge.moved, std::abs(std::abs(y[i]) - std::abs(y0[i])));
  }
  return charge;
}

TEST_CASE("the charge of U(1) stays to round-off over 2000 steps on every stencil") {
  for (const char* state : {"charged-wave", "charged-packet"})
    for (const std::string stencil : charge_stencils) {
      const Charge charge = charge_over_2000_steps(state, stencil.c_str());
      CAPTURE(state, stencil, charge.first, charge.drift, charge.moved);
      CHECK(std::abs(charge.first) > 0.1);
      CHECK(charge.moved > 0.1);
      CHECK(charge.drift < 1e-12);
    }
}

TEST_CASE("the charge stays because the density is invariant under rotations: with different masses it does not") {
  const ByName wave = charged("charged-wave", "rectangle-symmetric", 64, From::exact);
  const LinearSymmetry rotation{"rotation", {0, -1, 1, 0}, {0, 0}};
  const auto drift = [&](double excess) {
    const Lattice lattice = Lattice::circle(64, 6);
    auto evolution = Scheme{rectangle_symmetric, UnevenMass{excess}}.on(lattice, 0.5 * lattice.space_step());
    return relative_drift(evolution, {wave.exact_row(0), wave.exact_row(1)}, rotation, 1000);
  };
  const double even = drift(0), uneven = drift(0.3);
  CAPTURE(even, uneven);
  CHECK(even < 1e-12);
  CHECK(uneven > 1e-3);
}
