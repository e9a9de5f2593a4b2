// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/catch.hpp"
#include "tests/verification/element_run.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double periods = 10, until = 2 * std::numbers::pi * periods;

/// What rounding leaves of an orbit of Kepler's problem, e = 0.6, after ten periods in n steps.
struct Orbit {
  double error, angular_momentum;
};

Orbit orbit(const std::string& method, const ParameterValues& keys, int n) {
  Problem p;
  p.theory = "kepler", p.method = method, p.lattice = Lattice::point(), p.time_step = until / n;
  p.parameters = keys;
  StateRequest request;
  request.name = "kepler-orbit", request.components = 2, request.fields = {"q1", "q2"};
  ElementRun run(p, request);
  run.to(n);
  double L = -0.8;
  if (method == "cgvi") {
    const std::vector<double> q = run.fields(), momentum = run.simulation().dataset(0);
    L += q[0] * momentum[1] - q[1] * momentum[0];
  } else {
    L = 0;
  }
  return {run.error(), std::abs(L)};
}

ParameterValues keys(std::initializer_list<std::pair<const std::string, std::string>> texts,
                     std::initializer_list<std::pair<const std::string, int>> numbers = {}) {
  ParameterValues values;
  for (const auto& [key, text] : texts) values[key] = text;
  for (const auto& [key, number] : numbers) values[key] = number;
  return values;
}

struct Method {
  std::string name;
  ParameterValues keys;
  double error_of_method;  ///< of the exact solution of the equations at 10,000 steps, or what scheme.tolerance leaves
};
std::vector<Method> elements() {
  return {
      {"cgvi", keys({{"scheme.tableau", "gauss2"}}), 3.79e-7},
      {"cgvi", keys({{"scheme.tableau", "gauss4"}}), 0},
      {"cgvi", keys({{"scheme.tableau", "gauss6"}}), 0},
      {"cgvi", keys({{"scheme.tableau", "lobatto3"}}), 4.29e-7},
      {"cgvi", keys({{"scheme.tableau", "lobatto5"}}), 0},
      {"cgvi", keys({{"scheme.continuity", "multipliers"}}, {{"scheme.functions", 4}, {"scheme.points", 3}}), 2.5e-11},
      {"cgvi",
       keys({{"scheme.basis", "lagrange-gauss"}, {"scheme.continuity", "multipliers"}},
            {{"scheme.functions", 5}, {"scheme.points", 4}}),
       5e-11},
      {"radau-iia", keys({}, {{"scheme.stages", 5}}), 0}};
}

std::string label(const Method& m) {
  Problem p;
  p.theory = "kepler", p.method = m.name, p.lattice = Lattice::point(), p.time_step = 1, p.parameters = m.keys;
  return scheme_label(p);
}

}  // namespace

// Differences of rounded values over h, summed up by every step, left 2e-9 in 10,000 steps and 5e-7 in a million.
TEST_CASE("rounding in short steps of an orbit does not grow with their number") {
  for (const Method& m : elements()) {
    const Orbit end = orbit(m.name, m.keys, 10000);
    INFO(label(m) << ": error " << end.error << ", angular momentum " << end.angular_momentum);
    CHECK(end.error <= m.error_of_method + 1e-12);
    CHECK(end.angular_momentum <= 1e-13);
  }
}

// Of first order in time a body's traces are q and p: an orbit of Kepler's problem that is a circle.
TEST_CASE("rounding in short steps of discontinuous elements does not grow with their number") {
  Problem p;
  p.theory = "text", p.method = "dgvi", p.lattice = Lattice::point();
  p.parameters["theory.fields"] = std::string("q1, q2, p1, p2");
  p.parameters["theory.density"] = std::string("p1*q1_t + p2*q2_t - 0.5*(p1^2 + p2^2) + (q1^2 + q2^2)^-0.5");
  constexpr int n = 10000;
  p.time_step = 2 * std::numbers::pi / n;
  Simulation simulation(p);
  const std::vector<double> q{1, 0, 0, 1};
  std::vector<double> row, end(4);
  for (const Component& c : simulation.components()) row.push_back(c.role == Role::multiplier ? 0 : q[c.field]);
  simulation.start({row});
  while (simulation.newest() < n) simulation.step();
  simulation.copy_row(0, end);
  INFO("error " << distance(end, q));
  CHECK(distance(end, q) <= 2e-13);
}

// Differences of rounded values over h² are 1e-11 here, relative to the momenta that they make up.
TEST_CASE("residuals of short slabs of a field are rounding of the momenta") {
  for (const char* method : {"spacetime", "cgvi", "radau-iia"}) {
    Problem p;
    p.theory = "sine-gordon", p.method = method, p.lattice = Lattice::circle(12, 5), p.time_step = 1e-3;
    if (method == std::string("spacetime")) p.parameters["scheme.degree_time"] = 4;
    else p.parameters["scheme.space"] = std::string("spectral");
    p.parameters["scheme.degree_space"] = 4;
    StateRequest request;
    request.name = "kink-train", request.values["initial.speed"] = 0.3;
    ElementRun run(p, request);
    run.to(20);
    INFO(method << ": " << run.simulation().residual());
    CHECK(run.simulation().residual() <= 4e-15);
  }
}

TEST_CASE("a million steps of Gauss's method keep thirteen digits of an orbit", "[slow]") {
  const Orbit end = orbit("cgvi", keys({{"scheme.tableau", "gauss4"}}), 1000000);
  INFO("error " << end.error << ", angular momentum " << end.angular_momentum);
  CHECK(end.error <= 1e-12);
  CHECK(end.angular_momentum <= 1e-14);
}
