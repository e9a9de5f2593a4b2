// SPDX-License-Identifier: MIT
#include "schemes/system/momenta.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/simulation.hpp"
#include "schemes/state.hpp"
#include "schemes/stepping/evolution.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

using Row = std::vector<double>;

std::unique_ptr<State> state(const Problem& p, const std::string& name, double speed = 0) {
  StateRequest request;
  request.name = name, request.theory = p.theory;
  if (p.lattice.space() != Space::point) request.values["initial.speed"] = speed;
  return make_state(request, p.lattice);
}
Row values(const State& s, double t, const Lattice& lattice) {
  Row row(delf::at(lattice.sites() * s.components()));
  s.values(t, lattice, row);
  return row;
}

Problem on(const Lattice& lattice, const std::string& stencil, double time_step) {
  Problem p;
  p.lattice = lattice, p.stencil = stencil, p.time_step = time_step;
  return p;
}

/// The momenta of the field at the vertices, where it is not held.
Row of_field(const Simulation& simulation, int back) {
  const LatticeSystem& system = simulation.evolution().system();
  const Row p = simulation.momenta(back);
  Row result;
  for (int i = 0; i < system.lattice().sites(); ++i)
    if (!system.is_held(i, 0)) result.push_back(p[i * system.components()]);
  return result;
}

double largest(const Row& row) {
  double most = 0;
  for (const double x : row) most = std::max(most, std::abs(x));
  return most;
}
double relative_distance(const Row& a, const Row& b) {
  REQUIRE(a.size() == b.size());
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most / std::max(largest(a), largest(b));
}

}  // namespace

TEST_CASE("momenta of a body are the discrete Legendre transform of each of its Lagrangians") {
  struct Case {
    const char* stencil;
    double (*below)(double q, double next, double h);  // ∂L/∂q' of L(q, q')
    double (*above)(double q, double next, double h);  // −∂L/∂q
  };
  const Case cases[]{
      // L = h(½((q'−q)/h)² − V((q+q')/2)), V' = sin q
      {"midpoint", [](double q, double r, double h) { return (r - q) / h - h / 2 * std::sin((q + r) / 2); },
       [](double q, double r, double h) { return (r - q) / h + h / 2 * std::sin((q + r) / 2); }},
      // L = h(½((q'−q)/h)² − ½V(q) − ½V(q'))
      {"trapezoidal", [](double q, double r, double h) { return (r - q) / h - h / 2 * std::sin(r); },
       [](double q, double r, double h) { return (r - q) / h + h / 2 * std::sin(q); }},
      // L = h(½((q'−q)/h)² − V(q))
      {"vertex", [](double q, double r, double h) { return (r - q) / h; },
       [](double q, double r, double h) { return (r - q) / h + h * std::sin(q); }}};
  const double h = 0.1;
  for (const Case& c : cases) {
    CAPTURE(c.stencil);
    Problem p = on(Lattice::point(), c.stencil, h);
    p.theory = "pendulum";
    const auto swing = state(p, "pendulum-swing");
    Simulation simulation(p);
    simulation.start({values(*swing, 0, p.lattice), values(*swing, h, p.lattice)});
    for (int n = 0; n < 30; ++n) {
      simulation.step();
      Row q(1), next(1);
      simulation.copy_row(1, q), simulation.copy_row(0, next);
      CHECK(std::abs(simulation.momenta(0)[0] - c.below(q[0], next[0], h)) < 1e-13);
      CHECK(std::abs(simulation.momenta(1)[0] - c.above(q[0], next[0], h)) < 1e-13);
    }
  }
}

TEST_CASE("on a solution the momenta are the same from below and from above, and close to k phi_t") {
  const Lattice circle = Lattice::circle(200, 40), interval = Lattice::interval(201, 40);
  for (const char* stencil : {"triangle", "triangle-vertex", "rectangle", "rectangle-symmetric", "hexagon"})
    for (const Lattice& lattice : {circle, interval}) {
      if (stencil == std::string("hexagon") && !lattice.is_circle()) continue;
      const double h = 0.4 * lattice.space_step(), k = lattice.space_step();
      Problem p = on(lattice, stencil, h);
      const auto kink = state(p, "kink", 0.5);
      p.winding = lattice.is_circle() ? kink->winding() : 0;
      CAPTURE(stencil, lattice.is_circle());
      Simulation simulation(p);
      simulation.start({values(*kink, 0, lattice), values(*kink, h, lattice)});
      for (int n = 0; n < 20; ++n) {
        simulation.step();
        const Row below = of_field(simulation, 0);
        simulation.step();
        CHECK(relative_distance(below, of_field(simulation, 1)) < 1e-11);
      }
      Row velocities(delf::at(lattice.sites()));
      kink->velocities(static_cast<double>(simulation.newest()) * h, lattice, velocities);
      for (double& v : velocities) v *= k;
      if (!lattice.is_circle()) velocities.erase(velocities.begin()), velocities.pop_back();
      CHECK(relative_distance(of_field(simulation, 0), velocities) < 0.2);
    }
}

TEST_CASE("off a solution the momenta from below and from above differ") {
  const Lattice lattice = Lattice::circle(200, 40);
  const double h = 0.4 * lattice.space_step();
  Problem p = on(lattice, "rectangle", h);
  const auto kink = state(p, "kink", 0.5);
  p.winding = kink->winding();
  const Simulation simulation(p);
  std::vector<Row> rows;
  for (int j = 0; j < 3; ++j) rows.push_back(values(*kink, j * h, lattice));
  const LatticeSystem& system = simulation.evolution().system();
  const Window exact = system.window(0, rows, 2 * std::numbers::pi);
  rows[1][100] += 0.01;
  const Window wrong = system.window(0, rows, 2 * std::numbers::pi);
  const auto difference = [&](const Window& w) {
    return relative_distance(momenta(system, w, 1, Side::below), momenta(system, w, 1, Side::above));
  };
  CHECK(difference(exact) < 0.01);  // the exact solution is one but for the scheme's error
  CHECK(difference(wrong) > 0.15);
}

TEST_CASE("momenta of compositions and of elements: those of the start, and handed on from step to step") {
  const Lattice lattice = Lattice::circle(60, 40);
  for (const char* method : {"composition", "spacetime"}) {
    CAPTURE(method);
    Problem p = on(lattice, "rectangle", 0.3 * lattice.space_step());
    p.method = method;
    const auto kink = state(p, "kink", 0.3);
    p.winding = kink->winding();
    Simulation simulation(p);
    const auto C = simulation.components().size();
    Row row0, velocity;
    for (int i = 0; i < lattice.sites(); ++i)
      for (const Component& c : simulation.components()) {
        FieldPoint point;
        kink->at(0, lattice.position(i) + c.at.space * lattice.space_step(), {&point, 1});
        row0.push_back(point.phi), velocity.push_back(point.phi_t);
      }
    simulation.start_legendre(row0, velocity);
    const Row first = simulation.momenta(1);
    double sum = 0, expected = 0;
    for (int i = 0; i < lattice.sites(); ++i)
      for (std::size_t c = 0; c < C; ++c) {
        const auto at = delf::at(i) * C + c;
        if (method == std::string("composition") && c == 0)
          CHECK(std::abs(first[at] - lattice.space_step() * velocity[at]) < 1e-13);
        if (simulation.components()[c].at.time == 0) sum += first[at];
        if (c == 0) expected += lattice.space_step() * velocity[at];
      }
    CHECK(std::abs(sum - expected) < 1e-3 * std::abs(expected));  // ∫ φ_t dx
    for (int n = 0; n < 10; ++n) {
      const Row below = of_field(simulation, 0);
      simulation.step();
      CHECK(relative_distance(below, of_field(simulation, 1)) < 1e-11);
    }
  }
}

TEST_CASE("a scheme without a Lagrangian has no momenta") {
  const Lattice lattice = Lattice::circle(60, 40);
  Problem p = on(lattice, "rectangle", 0.3 * lattice.space_step());
  p.method = "guo";
  const auto kink = state(p, "kink");
  p.winding = kink->winding();
  Simulation simulation(p);
  simulation.start({values(*kink, 0, lattice), values(*kink, p.time_step, lattice)});
  CHECK_THROWS_AS(simulation.momenta(), BadInput);
}
