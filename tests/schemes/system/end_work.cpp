// SPDX-License-Identifier: MIT
#include "schemes/system/end_work.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/driven_ends.hpp"
#include "schemes/methods/method_registry.hpp"
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
  const std::size_t C = simulation.components().size();
  const Row zero(at(p.lattice.sites()) * C, 0.0);
  Row row0 = zero;
  for (std::size_t c = 0; c < C; ++c)
    for (int i = 0; simulation.components()[c].position && i < p.lattice.sites(); ++i)
      row0[at(i) * C + c] = p.lattice.position(i);
  const std::vector<StartRule>& starts = find_method(p.method).starts;
  const auto knows = [&](StartRule rule) { return std::ranges::find(starts, rule) != starts.end(); };
  if (knows(StartRule::legendre)) simulation.start_legendre(row0, zero);
  else if (knows(StartRule::centred)) simulation.start_centred(zero, zero);
  else simulation.start({zero});
  return simulation;
}

/// The energy at the end, and the largest gap of E − W from its start.
struct Balance {
  double energy = 0, gap = 0;
};
Balance run(const Problem& p, double until) {
  Simulation simulation = at_rest(p);
  const Stepper& stepper = simulation.evolution().stepper();
  EndWork work(simulation.evolution().system(), simulation.theory().shared_density(),
               end_fluxes(simulation.theory(), p));
  const auto add = [&] {
    if (stepper.newest() > 1 || work.by_elements())
      work.add(stepper.window(static_cast<int>(std::min<std::int64_t>(3, stepper.newest() + 1))));
  };
  add();
  const double first = simulation.monitors().energy;
  Balance balance;
  while (simulation.time(simulation.newest()) < until) {
    simulation.step();
    add();
    balance.energy = simulation.monitors().energy;
    balance.gap = std::max(balance.gap, std::abs(balance.energy - first - work.sum()));
  }
  return balance;
}

/// A method with elements in time, and its order.
struct InTime {
  std::string name, method;
  ParameterValues keys;
  int order;
};
ParameterValues keys_of(std::initializer_list<std::pair<const char*, ParameterValue>> list) {
  ParameterValues keys;
  for (const auto& [key, value] : list) keys[key] = value;
  return keys;
}
std::vector<InTime> in_time() {
  return {
      {"gauss2", "cgvi", keys_of({{"scheme.tableau", "gauss2"}}), 4},
      {"lobatto3", "cgvi", keys_of({{"scheme.tableau", "lobatto3"}}), 4},
      {"gauss2, consistent mass", "cgvi", keys_of({{"scheme.tableau", "gauss2"}, {"scheme.space", "linear"}}), 4},
      {"gauss2, spectral", "cgvi", keys_of({{"scheme.tableau", "gauss2"}, {"scheme.space", "spectral"}}), 4},
      {"multipliers", "cgvi",
       keys_of({{"scheme.basis", "lagrange-gauss"}, {"scheme.functions", 3}, {"scheme.points", 2}}), 4},
      {"radau", "radau-iia", keys_of({{"scheme.stages", 2}}), 3},
      {"spacetime", "spacetime", {}, 4},
      {"composition", "composition", keys_of({{"scheme.order", 4}, {"lattice.space_order", 2}}), 4},
      {"uniform mesh", "r-adaptive", keys_of({{"scheme.strategy", "uniform"}, {"scheme.time", "gauss2"}}), 4},
      {"moving mesh", "r-adaptive",
       keys_of({{"scheme.strategy", "control"}, {"scheme.time", "gauss2"}, {"mesh.alpha", 0.2}}), 4},
      {"multiplier mesh", "r-adaptive", keys_of({{"scheme.time", "trapezoid"}, {"mesh.alpha", 0.2}}), 2},
  };
}
/// The sine-Gordon field on 9 sites, which the left end moves up to a nonlinear amplitude: smooth from rest on.
Problem on_few_sites(const InTime& method, double time_step, bool by_flux) {
  Problem p = chain(9, 0.5);
  p.method = method.method, p.parameters = method.keys, p.time_step = time_step;
  return by_flux ? pushed(p, "1.5*sin(0.9*t)^6") : driven(p, "2.2*sin(0.9*t)^6");
}
Row row_at(const Problem& p, double until) {
  Simulation simulation = at_rest(p);
  while (simulation.time(simulation.newest()) < until - 1e-9) simulation.step();
  Row row(at(p.lattice.sites() * simulation.count(Role::field)));
  simulation.copy_row(0, row);
  return row;
}
double apart(const Row& a, const Row& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
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

TEST_CASE("elements in time, sub-steps and moving meshes keep their order beside a driven end, and behind a flux") {
  for (const InTime& method : in_time())
    for (const bool by_flux : {false, true}) {
      if (by_flux && method.method == "r-adaptive") continue;  // between fixed walls
      CAPTURE(method.name, by_flux);
      const double h = method.order > 3 ? 0.2 : 0.1, until = 4;
      const Row finest = row_at(on_few_sites(method, h / 16, by_flux), until);
      const double coarse = apart(row_at(on_few_sites(method, h, by_flux), until), finest),
                   fine = apart(row_at(on_few_sites(method, h / 2, by_flux), until), finest);
      const double order = std::log2(coarse / fine);
      CAPTURE(coarse, fine, order);
      CHECK(fine < 0.01);
      CHECK(order > method.order - 0.3);
      CHECK(order < method.order + 0.3);
    }
}

TEST_CASE("the energy of elements less the work of their ends stays to their order") {
  for (const InTime& method : in_time())
    for (const bool by_flux : {false, true}) {
      if (by_flux && method.method == "r-adaptive") continue;
      CAPTURE(method.name, by_flux);
      if (method.name == "moving mesh") continue;  // one that is not varied keeps no energy
      // a wall moves along straight lines between sub-steps
      const int expected = method.method == "composition" && !by_flux ? 2 : method.order;
      const double h = method.order > 3 ? 0.2 : 0.1;
      const Balance rough = run(on_few_sites(method, h, by_flux), 4),
                    fine = run(on_few_sites(method, h / 2, by_flux), 4);
      const double order = std::log2(rough.gap / fine.gap);
      CAPTURE(rough.energy, rough.gap, fine.gap, order);
      CHECK(fine.energy > 0.3);
      CHECK(fine.gap < 0.01 * fine.energy);
      CHECK(order > expected - 0.3);
      CHECK(order < expected + 0.3);
    }
}

TEST_CASE("an element driven in its gap transmits above the threshold, and not below it") {
  // Geniet and Leon: 2(1 − Ω²) = 0.38 for the slope at the end, Ω = 0.9
  Problem p = chain(81, 0.5);
  p.method = "cgvi", p.parameters["scheme.tableau"] = "gauss2", p.time_step = 0.5;
  const std::string slow = "*sin(0.9*t)*(1 - exp(-t/20))";
  const double gentle = run(pushed(p, "0.30" + slow), 160).energy, strong = run(pushed(p, "0.46" + slow), 160).energy;
  CHECK(gentle < 3);
  CHECK(strong > 4 * gentle);
}

TEST_CASE("discontinuous elements take the values of both fields of a Schroedinger equation at an end") {
  // i ψ_t + ψ_xx/2 + |ψ|² ψ = 0, ψ = sech(x − 5) exp(i t/2)
  const auto at_step = [](double time_step) {
    Problem p = chain(41, 0.25, "text");
    p.parameters["theory.fields"] = "a, b";
    p.parameters["theory.density"] = "b*a_t - 0.25*(a_x^2 + b_x^2) + 0.25*(a^2 + b^2)^2";
    p.method = "dgvi", p.time_step = time_step;
    p.parameters[left_end] = "0.5*cos(t/2)*sin(t)^4; 0.5*sin(t/2)*sin(t)^4";
    return p;
  };
  const Row finest = row_at(at_step(0.0025), 1);
  const double coarse = apart(row_at(at_step(0.02), 1), finest), fine = apart(row_at(at_step(0.01), 1), finest);
  CAPTURE(coarse, fine);
  CHECK(fine < 1e-3);
  CHECK(std::log2(coarse / fine) > 3.5);
  const Balance balance = run(at_step(0.01), 1);
  CAPTURE(balance.energy, balance.gap);
  CHECK(balance.energy > 0.01);
  CHECK(balance.gap < 1e-3 * balance.energy);
}

TEST_CASE("the work at a driven wall is of second order on stencils that share its inertia otherwise") {
  for (const char* stencil : {"triangle-vertex", "triangle", "rectangle"}) {
    CAPTURE(stencil);
    const auto gap = [&](int sites, bool left) {
      Problem p = chain(sites, 10.0 / (sites - 1), "wave");
      p.stencil = stencil;
      p.parameters[left ? left_end : right_end] = "1.2*sin(0.9*t)^3";
      const Balance balance = run(p, 12);
      return balance.gap / balance.energy;
    };
    for (const bool left : {true, false}) {
      const double coarse = gap(51, left), fine = gap(101, left);
      CAPTURE(coarse, fine);
      CHECK(fine < 0.02);
      CHECK(coarse / fine > 3.5);
    }
  }
}

TEST_CASE("comparators, whose equations reach beyond a wall, count its work too") {
  for (const char* method : {"vu-quoc-li", "guo"}) {
    CAPTURE(method);
    const auto gap = [&](int sites) {
      Problem p = driven(chain(sites, 10.0 / (sites - 1)), "1.2*sin(0.9*t)^3");
      p.method = method;
      const Balance balance = run(p, 12);
      CHECK(balance.energy > 0.5);
      return balance.gap / balance.energy;
    };
    const double coarse = gap(51), fine = gap(101);
    CAPTURE(coarse, fine);
    CHECK(fine < 0.05);
    CHECK(coarse / fine > 3.5);
  }
}

TEST_CASE("ends that a scheme cannot have are refused by their key, with a remedy that works") {
  const auto refused = [](Problem p, const std::string& remedy) {
    const std::string words = message_of([&] { Simulation{p}; });
    CAPTURE(words);
    CHECK(words.find(remedy) != std::string::npos);
  };
  Problem p = driven(chain(41, 0.25), "sin(t)");
  p.method = "composition";
  refused(p, "lattice.space_order = 2");
  p.parameters["lattice.space_order"] = 2;
  CHECK_NOTHROW(Simulation{p});
  p = driven(chain(41, 0.25), "sin(t)");
  p.method = "processed";
  refused(p, "scheme.method = composition and lattice.space_order = 2");
  p.method = "cgvi", p.parameters["scheme.basis"] = "bernstein", p.parameters["scheme.functions"] = 4;
  refused(p, "scheme.basis = lagrange-lobatto");
  p.parameters["scheme.basis"] = "lagrange-lobatto";
  CHECK_NOTHROW(Simulation{p});
  p = driven(chain(41, 0.25), "sin(t); cos(t)");
  CHECK(refused_key([&] { Simulation{p}; }) == "boundary.left");
  p = driven(chain(41, 0.25), "sin(");
  CHECK(refused_key([&] { Simulation{p}; }) == "boundary.left");
}
