// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "jets/tables/hexagon_jet.hpp"
#include "jets/tables/named_tables.hpp"
#include "lattice/error.hpp"
#include "schemes/scheme.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/phi4.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

constexpr int sites = 64;  // even, for brick walls

std::vector<std::vector<double>> two_rows(double time_step) {
  std::vector<std::vector<double>> rows(2, std::vector<double>(sites));
  for (int i = 0; i < sites; ++i) {
    const double angle = 2 * std::numbers::pi * i / sites;
    rows[0][i] = 2 * std::sin(angle);
    rows[1][i] = 2 * std::sin(angle) + time_step * 0.3 * std::cos(2 * angle);
  }
  return rows;
}

/// The row after so many steps.
std::vector<double> stepped(Problem p, int steps) {
  p.lattice = Lattice::circle(sites, 20);
  p.time_step = 0.5 * p.lattice.space_step();
  Simulation simulation(p);
  simulation.start(two_rows(p.time_step));
  simulation.steps(steps);
  std::vector<double> row(sites);
  simulation.copy_row(0, row);
  return row;
}

double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  return worst;
}

}  // namespace

TEST_CASE("sine-Gordon as text steps like the built-in one on every stencil, for 1000 steps") {
  for (const NamedTable& table : named_tables()) {
    INFO(table.name);
    if (std::ranges::all_of(table.table.pattern.vertices, [](const auto& v) { return v.space == 0; }))
      continue;  // of mechanics
    Problem built_in;
    built_in.stencil = table.name;
    Problem text = built_in;
    text.theory = "text";
    text.parameters["theory.density"] = "0.5*phi_t^2 - 0.5*phi_x^2 + m^2*(cos(phi) - 1)";
    text.parameters["theory.parameters"] = "m = 2";
    Problem other = text;
    text.parameters["theory.m"] = 1.0;
    const auto expected = stepped(built_in, 1000);
    CHECK(difference(stepped(text, 1000), expected) < 1e-12);
    CHECK(difference(stepped(other, 50), stepped(built_in, 50)) > 1e-3);  // the comparison can fail
  }
}

TEST_CASE("a scheme takes a density as text") {
  const auto run = [](const auto& scheme) {
    const auto lattice = Lattice::circle(sites, 20);
    auto evolution = scheme.on(lattice, 0.1);
    evolution.stepper().start(two_rows(0.1));
    for (int n = 0; n < 200; ++n) evolution.stepper().step();
    return evolution.stepper().row(0);
  };
  CHECK(difference(run(Scheme{hexagon, expression("0.5*phi_t^2 - 0.5*phi_x^2 - 0.25*(phi^2 - 1)^2")}),
                   run(Scheme{hexagon, PhiFour{1.0}})) < 1e-12);
}
