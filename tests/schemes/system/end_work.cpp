// SPDX-License-Identifier: MIT
#include "schemes/system/end_work.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/driven_ends.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/theories/field_theory.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// A chain of pendula that are a unit apart, at rest: φ̈_n = φ_{n+1} − 2φ_n + φ_{n−1} − sin φ_n, coupling² c.
Problem chain(int sites, double spacing, const std::string& theory = "sine-gordon") {
  Problem p;
  p.theory = theory, p.stencil = "rectangle-symmetric";
  p.lattice = Lattice::interval(sites, spacing * (sites - 1));
  p.time_step = 0.5 * spacing;
  return p;
}
Problem driven(Problem p, const std::string& motion) {
  p.parameters[left_end] = motion;
  return p;
}
Problem pushed(Problem p, const std::string& flux) {
  p.lattice = Lattice::interval(p.lattice.sites(), p.lattice.length(), Wall::natural);
  p.parameters[left_flux] = flux;
  return p;
}
Simulation at_rest(const Problem& p) {
  Simulation simulation(p);
  const Row zero(at(p.lattice.sites()), 0.0);
  simulation.start_centred(zero, zero);
  return simulation;
}

/// The energy at the end, and the largest gap of E − W from its start.
struct Balance {
  double energy = 0, gap = 0;
};
Balance run(const Problem& p, double until) {
  Simulation simulation = at_rest(p);
  const Stepper& stepper = simulation.evolution().stepper();
  EndWork work(simulation.evolution().system(), end_fluxes(simulation.theory(), p));
  const double first = simulation.monitors().energy;
  Balance balance;
  while (simulation.time(simulation.newest()) < until) {
    simulation.step();
    work.add(stepper.window(3));
    balance.energy = simulation.monitors().energy;
    balance.gap = std::max(balance.gap, std::abs(balance.energy - first - work.sum()));
  }
  return balance;
}

}  // namespace

TEST_CASE("a driven wall moves as its formula says, and the wave behind it is d'Alembert's") {
  const auto error = [](int sites) {
    Problem p = driven(chain(sites, 10.0 / (sites - 1), "wave"), "sin(t)^3");
    Simulation simulation = at_rest(p);
    while (simulation.time(simulation.newest()) < 7.99) simulation.step();
    Row row(at(sites));
    simulation.copy_row(0, row);
    const double t = simulation.time(simulation.newest());
    double most = 0;
    for (int i = 0; i < sites; ++i) {
      const double late = t - p.lattice.position(i);
      most = std::max(most, std::abs(row[at(i)] - (late > 0 ? std::pow(std::sin(late), 3) : 0)));
    }
    CHECK(std::abs(row[0] - std::pow(std::sin(t), 3)) < 4e-16);
    return most;
  };
  const double coarse = error(101), fine = error(201);
  CHECK(fine < 0.01);
  CHECK(coarse / fine > 3.5);
}

TEST_CASE("the energy of a driven field less the work of its ends stays, to second order") {
  for (const bool by_flux : {false, true}) {
    INFO("by a flux: " << by_flux);
    const auto gap = [&](int sites) {
      const Problem p = chain(sites, 10.0 / (sites - 1));
      const Balance balance = run(by_flux ? pushed(p, "0.8*sin(0.9*t)") : driven(p, "1.2*sin(0.9*t)"), 12);
      CHECK(balance.energy > 0.05);
      return balance.gap / balance.energy;
    };
    const double coarse = gap(51), fine = gap(101);
    CHECK(fine < 0.02);
    CHECK(coarse / fine > 3);
  }
}

TEST_CASE("a chain driven in its gap transmits above the threshold, and not below it") {
  // Geniet and Leon, Phys. Rev. Lett. 89, 134102 (2002): A = 4 arctan(√(1 − Ω²)/Ω), 1.804 at Ω = 0.9, for the value at the
  // end; 2(1 − Ω²) = 0.38 for its slope.
  const auto energy = [](const Problem& p) { return run(p, 200).energy; };
  const Problem p = chain(161, 0.25);
  const std::string slow = "*sin(0.9*t)*(1 - exp(-t/20))";
  const double below = energy(driven(p, "1.6" + slow)), above = energy(driven(p, "2.0" + slow));
  CHECK(below < 3);
  CHECK(above > 4 * below);
  const double gentle = energy(pushed(p, "0.30" + slow)), strong = energy(pushed(p, "0.46" + slow));
  CHECK(gentle < 3);
  CHECK(strong > 4 * gentle);
}

TEST_CASE("ends that a scheme cannot move are refused by their key") {
  Problem p = pushed(chain(41, 0.25), "sin(t)");
  p.method = "cgvi";
  CHECK(refused_key([&] { Simulation{p}; }) == "boundary.left.flux");
  p = driven(chain(41, 0.25), "sin(t)");
  p.method = "cgvi";
  CHECK(refused_key([&] { Simulation{p}; }) == "boundary.left");
  p = driven(chain(41, 0.25), "sin(t); cos(t)");
  CHECK(refused_key([&] { Simulation{p}; }) == "boundary.left");
  p = driven(chain(41, 0.25), "sin(");
  CHECK(refused_key([&] { Simulation{p}; }) == "boundary.left");
}
