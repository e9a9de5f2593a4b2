// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "lattice/error.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/families/mesh_constraint.hpp"
#include "schemes/methods/moving_parts.hpp"
#include "tests/catch.hpp"
#include "tests/verification/r_adaptive_run.hpp"
#include "tests/verification/r_adaptive_steps.hpp"

using namespace delf;

namespace {

namespace reference = r_adaptive_steps;
using namespace r_adaptive_run;

/// Of row 10 from that of the independent program.
double distance_at_row_10(const reference::Reference& of, double alpha = 2.5) {
  const int sites = of.nodes + 2;
  Simulation simulation = started(problem(of.strategy, of.time, of.nodes, alpha), kink);
  while (simulation.newest() < 10) simulation.step();
  const double phi = distance(values(simulation, sites, false), of.y);
  return of.strategy == "uniform" ? phi : std::max(phi, distance(values(simulation, sites, true), of.X));
}

}  // namespace

TEST_CASE("a moving mesh starts where an independent program has it, to 1e-12, with its rates") {
  for (const auto& [nodes, X, X_rate] :
       {std::tuple{15, &reference::X_15, &reference::X_rate_15}, {22, &reference::X_22, &reference::X_rate_22}}) {
    const MovingSites sites = place_moving_sites({.alpha = 2.5}, Lattice::interval(nodes + 2, 25), 1, kink);
    CHECK(distance(sites.X, *X) < 1e-12);
    CHECK(distance(sites.X_t, *X_rate) < 1e-12);
  }
  const MovingSites another = place_moving_sites({.alpha = 2.51}, Lattice::interval(17, 25), 1, kink);
  CHECK(distance(another.X, reference::X_15) > 1e-4);
}

TEST_CASE("every strategy and element in time gives row 10 of an independent program to 1e-11") {
  for (const reference::Reference& of : reference::references) {
    CAPTURE(of.strategy, of.time);
    CHECK(distance_at_row_10(of) < 1e-11);
  }
}

TEST_CASE("moving meshes have the order in time of their element, from below and from above") {
  const auto at_time = [](const std::string& strategy, const std::string& time, int steps) {
    Problem p = problem(strategy, time, 15);
    p.time_step = 0.16 / steps;
    Simulation simulation = started(p, kink);
    while (simulation.newest() < steps) simulation.step();
    Row all = values(simulation, 17, false);
    const Row X = values(simulation, 17, true);
    all.insert(all.end(), X.begin(), X.end());
    return all;
  };
  for (const auto& [strategy, time, order] :
       std::vector<std::tuple<std::string, std::string, double>>{{"multiplier", "trapezoid", 2},
                                                                 {"multiplier", "midpoint", 2},
                                                                 {"multiplier", "lobatto2", 2},
                                                                 {"multiplier", "lobatto3", 4},
                                                                 {"control", "trapezoid", 2},
                                                                 {"control", "midpoint", 2},
                                                                 {"control", "gauss1", 2},
                                                                 {"control", "gauss2", 4},
                                                                 {"control", "lobatto2", 2},
                                                                 {"control", "lobatto3", 4},
                                                                 {"control", "radau3", 5}}) {
    const Row coarse = at_time(strategy, time, 4), middle = at_time(strategy, time, 8),
              fine = at_time(strategy, time, 16);
    const double seen = std::log2(distance(coarse, middle) / distance(middle, fine));
    CAPTURE(strategy, time, seen);
    CHECK(seen > order - 0.3);
    CHECK(seen < order + 0.3);
  }
}

TEST_CASE("the comparison with row 10 can fail: another alpha moves the mesh elsewhere") {
  CHECK(distance_at_row_10(reference::references[2], 2.51) > 1e-4);
}

TEST_CASE("the exact integral of moving cells is that of many points, and not that of two") {
  for (const auto& [strategy, time] : {std::pair{"multiplier", "trapezoid"},
                                       {"control", "trapezoid"},
                                       {"multiplier", "lobatto3"},
                                       {"control", "gauss2"}}) {
    const auto row_5 = [&strategy = strategy, &time = time](const char* points, double mass) {
      Problem p = problem(strategy, time, 15);
      p.parameters["mesh.points"] = points, p.parameters["theory.mass"] = mass;
      Simulation simulation = started(p, kink);
      while (simulation.newest() < 5) simulation.step();
      return values(simulation, 17, false);
    };
    CAPTURE(strategy, time);
    const Row exact = row_5("exact", 1.5);
    CHECK(distance(exact, row_5("20", 1.5)) < 1e-11);
    CHECK(distance(exact, row_5("2", 1.5)) > 1e-9);
    CHECK(distance(exact, row_5("exact", 1)) > 1e-4);
  }
  Problem p = problem("multiplier", "trapezoid", 15);
  for (const char* points : {"1", "21", "8.5", "many"}) {
    p.parameters["mesh.points"] = points;
    CHECK_THROWS_AS(Simulation(p), BadInput);
  }
}

TEST_CASE("multipliers keep the energy of a moving mesh, and a slaved one does not") {
  const auto change = [](const std::string& strategy, const std::string& time) {
    Simulation simulation = started(problem(strategy, time, 22), kink);
    simulation.step();
    const double before = simulation.monitors().energy;
    CHECK(before == Approx(18.0657).margin(1e-3));
    while (simulation.newest() < 10) simulation.step();
    return std::abs(simulation.monitors().energy - before);
  };
  CHECK(change("multiplier", "lobatto3") < 1e-7);
  CHECK(change("control", "gauss2") > 1e-4);
}

TEST_CASE("a mesh that cannot be followed to its monitor is refused, and so is what multipliers cannot keep") {
  // a profile with a step: between two sites nothing tells where it is
  const StartField step = [](double x, std::span<FieldPoint> out) { out[0] = {x > 12.3 ? 6.0 : 0.0, 0, 0}; };
  CHECK_THROWS_AS(place_moving_sites({.alpha = 50}, Lattice::interval(17, 25), 1, step), NoConvergence);
  CHECK_THROWS_AS(Simulation(problem("multiplier", "gauss2", 15)), BadInput);
  Problem circle = problem("control", "gauss1", 15);
  circle.lattice = Lattice::circle(17, 25);
  CHECK_THROWS_AS(Simulation(circle), BadInput);
}

TEST_CASE("other densities and monitors move the mesh too, and keep their constraint") {
  Problem p = problem("multiplier", "lobatto2", 15);
  p.theory = "phi4";
  const StartField phi4 = [](double x, std::span<FieldPoint> out) {
    const double s = (x - 12.5) / std::numbers::sqrt2;
    out[0] = {std::tanh(s), 0, 1 / (std::numbers::sqrt2 * std::cosh(s) * std::cosh(s))};
  };
  for (const char* monitor : {"arclength", "saturated", "uniform", "sqrt(1 + 4*phi_X^2)"}) {
    p.parameters["mesh.monitor"] = monitor;
    Simulation simulation = started(p, phi4);
    for (int n = 0; n < 5; ++n) simulation.step();
    CAPTURE(monitor);
    CHECK(simulation.monitors().constraint < 1e-12);
    const Row X = values(simulation, 17, true);
    CHECK(std::ranges::is_sorted(X));
    CHECK((std::abs(X[4] - 6.25) > 0.1) == (std::string(monitor) != "uniform"));
  }
}

TEST_CASE("the margin of a mesh is what cells of equal arclength leave of the length") {
  const auto constraint = [](const MeshMonitor& monitor) { return MeshConstraint{.d = 1, .monitor = monitor}; };
  const std::vector<double> y{0, 0.6, 1.6};
  CHECK(*constraint({.alpha = 0.5}).margin(y, 1, 1) == Approx(1 - 0.5 * 0.8));
  CHECK(*constraint({.alpha = 1.5}).margin(y, 1, 1) == Approx(-0.2));
  CHECK_FALSE(constraint({.kind = MeshMonitor::Kind::saturated}).margin(y, 1, 1));
}

TEST_CASE("cells that turn over between two rows end a run, and the rows before are in order") {
  Problem p = problem("control", "gauss1", 12, 1.2);
  p.time_step = 0.1;
  Simulation simulation = started(p, kink_of<97>);
  std::string failure;
  try {
    while (simulation.newest() < 30) simulation.step();
  } catch (const MeshCrossing& crossing) {
    failure = crossing.what();
  }
  CAPTURE(failure);
  CHECK(failure.find("pass each other at 0.5 of the step; in the row before, sites 7 and 8 are 0.0") !=
        std::string::npos);
  CHECK(std::ranges::is_sorted(values(simulation, 14, true)));
}

TEST_CASE("a run that breaks keeps its energy until then: roots that leave the motion are none") {
  // beyond the explicit limit where the soliton meets the wall
  for (const double h : {0.04, 0.08}) {
    CAPTURE(h);
    Problem p = problem("multiplier", "trapezoid", 34);
    p.time_step = h;
    StateRequest request{.name = "soliton-bounce", .theory = "sine-gordon"};
    request.values["initial.speed"] = 0.9;
    const auto state = make_state(request, p.lattice);
    Simulation simulation = started(p, [&](double x, std::span<FieldPoint> out) { state->at(0, x, out); });
    const double first = simulation.monitors().energy;
    CHECK_THROWS_AS(
        [&] {
          while (simulation.time(simulation.newest()) < 16) simulation.step();
        }(),
        NumericalFailure);
    CHECK(simulation.time(simulation.newest()) > 13);
    CHECK(std::abs(simulation.monitors().energy / first - 1) < 0.05);
  }
}

TEST_CASE("a mesh that follows with a delay is another one, of order 2 in time, and for rows alone") {
  const auto run = [](const std::string& time, double delay, int steps) {
    Problem p = problem("control", time, 15);
    p.parameters["mesh.delay"] = delay, p.time_step = 0.2 / steps;
    Simulation simulation = started(p, kink);
    while (simulation.newest() < steps) simulation.step();
    return values(simulation, 17, true);
  };
  for (const char* time : {"midpoint", "trapezoid"}) {
    CAPTURE(time);
    // order 2 in time, the delay fixed
    const Row coarse = run(time, 0.5, 8), middle = run(time, 0.5, 16), fine = run(time, 0.5, 32);
    const double order = std::log2(distance(coarse, middle) / distance(middle, fine));
    CHECK(order > 1.7);
    CHECK(order < 2.3);
    CHECK(distance(fine, run(time, 0, 32)) > 1e-2);
  }
  Problem p = problem("multiplier", "trapezoid", 15);
  p.parameters["mesh.delay"] = 0.1;
  CHECK_THROWS_AS(Simulation(p), BadInput);
}
