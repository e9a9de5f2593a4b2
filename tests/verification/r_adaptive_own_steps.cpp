// SPDX-License-Identifier: MIT
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/stepping/step_density.hpp"
#include "schemes/system/momenta.hpp"
#include "tests/catch.hpp"
#include "tests/verification/r_adaptive_run.hpp"

using namespace delf;

namespace {

using namespace r_adaptive_run;

/// A hump at rest, which falls apart: it is steep, flat, and steep again.
void hump(double x, std::span<FieldPoint> out) {
  const double u = x - 12.5, phi = 3 * std::exp(-u * u / 2);
  out[0] = {.phi = phi, .phi_t = 0, .phi_x = -u * phi};
  if (x == 0 || x == 25) out[0] = {};
}

Problem own_steps(const std::string& strategy, const std::string& time, double longest, double alpha = 1) {
  Problem p = problem(strategy, time, 15, alpha);
  p.time_step = longest, p.step_control = 1;
  return p;
}

using Rule = std::function<void(Simulation&)>;
void by_density(Simulation& simulation) { simulation.step(); }
/// h = ε σ of the newest row alone.
Rule plain(double longest) {
  return [longest](Simulation& simulation) { simulation.step_by(longest / simulation.row_density().density); };
}

/// The distance of row 1 from where it was, after so many steps on and as many back.
double distance_after_way_back(const Problem& p, int steps, const Rule& rule) {
  Simulation there = started(p, hump);
  const auto& stepper = [](const Simulation& s) -> const Stepper& { return s.evolution().stepper(); };
  const std::vector<double> start = stepper(there).row(0);
  const double last_step = [&] {
    while (there.newest() < steps) rule(there);
    return there.time(steps) - there.time(steps - 1);
  }();
  Simulation back(p);
  const double density = p.time_step / last_step;  // the step between the last two rows is taken again
  const LatticeSystem& system = there.evolution().system();
  if (there.count(Role::inner) == 0 && there.count(Role::slaved) == 0) {
    back.start({stepper(there).row(0), stepper(there).row(1)}, density);
  } else {
    std::vector<double> momenta = half_equations(system, stepper(there).window(2), steps, Side::below);
    for (double& each : momenta) each = -each;
    back.start_momenta(stepper(there).row(0), momenta, density);
  }
  while (back.newest() < steps - 1) rule(back);
  double most = 0;
  const std::vector<double> end = stepper(back).row(0);
  for (std::size_t n = 0; n < end.size(); ++n) {
    const Component& c = system.component(static_cast<int>(n) % system.components());
    if (c.role == Role::field || c.position) most = std::max(most, std::abs(end[n] - start[n]));
  }
  return most;
}

/// φ of all sites at a time, by the polynomial through eight rows about it.
Row at_time(const Problem& p, double t) {
  Simulation simulation = started(p, hump);
  std::vector<std::pair<double, Row>> rows;
  while (rows.size() < 8 || rows[3].first < t) {
    simulation.step();
    rows.emplace_back(simulation.time(simulation.newest()), values(simulation, 17, false));
    if (rows.size() > 8) rows.erase(rows.begin());
  }
  Row sum(17, 0.0);
  for (const auto& [time, row] : rows) {
    double weight = 1;
    for (const auto& other : rows)
      if (other.first != time) weight *= (t - other.first) / (time - other.first);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * row[i];
  }
  return sum;
}

}  // namespace

TEST_CASE("what a row asks of its steps is told with its rate: G is the derivative of log 1/sigma") {
  for (const auto& [strategy, time] :
       {std::pair{"multiplier", "trapezoid"}, {"control", "gauss1"}, {"uniform", "gauss1"}}) {
    CAPTURE(strategy);
    // at the middle of three rows, whose steps differ by O(h²)
    const auto error = [&](double longest) {
      Simulation simulation = started(own_steps(strategy, time, longest), hump);
      std::vector<std::pair<double, RowDensity>> rows;
      double most = 0;
      while (simulation.time(simulation.newest()) < 1) {
        simulation.step();
        rows.emplace_back(simulation.time(simulation.newest()), simulation.row_density());
        if (rows.size() < 3) continue;
        const auto& [before, here, after] = std::tie(rows[rows.size() - 3], rows[rows.size() - 2], rows.back());
        const double slope = std::log(after.second.density / before.second.density) / (after.first - before.first);
        most = std::max(most, std::abs(slope - here.second.slope));
      }
      return most;
    };
    const double order = std::log2(error(0.02) / error(0.01));
    CHECK(order > 1.7);
    CHECK(order < 2.3);
  }
}

TEST_CASE("with steps that the rows choose a scheme keeps its order") {
  for (const auto& [strategy, time, order] : {std::tuple{"multiplier", "trapezoid", 2},
                                              {"control", "midpoint", 2},
                                              {"uniform", "trapezoid", 2},
                                              {"control", "gauss2", 4}}) {
    CAPTURE(strategy, time);
    const double coarse = order == 2 ? 0.05 : 0.1;
    const Row end = at_time(own_steps(strategy, time, coarse / 8), 1);
    const auto error = [&](double longest) { return distance(at_time(own_steps(strategy, time, longest), 1), end); };
    const double found = std::log2(error(coarse) / error(coarse / 2));
    CHECK(found > order - 0.3);
    CHECK(found < order + 0.3);
  }
}

TEST_CASE("a run back takes the steps that the rows chose again, and a plain choice does not") {
  for (const auto& [strategy, time] : {std::pair{"multiplier", "trapezoid"},
                                       {"uniform", "trapezoid"},
                                       {"control", "midpoint"},
                                       {"control", "gauss2"}}) {
    CAPTURE(strategy, time);
    const Problem p = own_steps(strategy, time, 0.1);
    CHECK(distance_after_way_back(p, 30, by_density) < 1e-10);
    CHECK(distance_after_way_back(p, 30, plain(p.time_step)) > 1e-4);
  }
}

TEST_CASE("steps of their own are for schemes that start from momenta, and for no others") {
  Problem p = own_steps("multiplier", "trapezoid", 0.1);
  Simulation simulation(p);
  const std::vector<double> row(at(17) * 3, 0.0);
  CHECK_THROWS_AS(simulation.start({row, row}), BadInput);
  CHECK_THROWS_AS(simulation.start_centred(row, row), BadInput);
  p.method = "multisymplectic", p.parameters = {};
  CHECK_THROWS_AS(Simulation(p), BadInput);
}

TEST_CASE("a step that fails leaves the times of the rows as they were") {
  Problem p = own_steps("multiplier", "trapezoid", 0.05);
  Simulation simulation = started(p, hump);
  simulation.step();
  const double t = simulation.time(simulation.newest());
  CHECK_THROWS_AS(simulation.step_by(100), NumericalFailure);
  CHECK(simulation.time(simulation.newest()) == t);
  CHECK_NOTHROW(simulation.step());
}
