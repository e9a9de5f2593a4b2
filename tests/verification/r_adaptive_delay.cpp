// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "schemes/stepping/evolution.hpp"
#include "tests/catch.hpp"
#include "tests/verification/r_adaptive_run.hpp"

using namespace delf;

namespace {

using namespace r_adaptive_run;

/// (φ, X, λ = 0) of the newest row.
Row of_all(const Simulation& simulation, int sites) {
  const Row phi = values(simulation, sites, false), X = values(simulation, sites, true);
  Row row;
  for (std::size_t i = 0; i < phi.size(); ++i) row.insert(row.end(), {phi[i], X[i], 0});
  return row;
}

/// The change of the energy from row 1 on, and what the mesh has taken from it. Where X(t) is not varied,
/// H = φ_t·∂L/∂φ_t + X_t·∂L/∂X_t − L has, along φ's own equations,
///
///     dH/dt = −X_t·E_X,    E_X = ∂L/∂X − d/dt ∂L/∂X_t
///
/// h E_X is what the scheme that varies X has as its equation there, without multipliers.
struct Balance {
  double change, work;
};
Balance balance(const std::string& time, double delay, double h, double until) {
  Problem p = problem("control", time, 25);
  p.parameters["mesh.delay"] = delay, p.time_step = h;
  Simulation simulation = started(p, kink);
  Problem of_varied = problem("multiplier", time, 25);
  of_varied.time_step = h;
  const Simulation varied(of_varied);
  const LatticeSystem& system = varied.evolution().system();
  const int N = system.lattice().sites(), steps = static_cast<int>(std::lround(until / h));
  std::vector<Row> rows{of_all(simulation, N)};  // from row 1 on
  std::vector<double> energies{simulation.monitors().energy}, power;
  while (simulation.newest() < steps + 1) {
    simulation.step();
    rows.push_back(of_all(simulation, N));
    energies.push_back(simulation.monitors().energy);
  }
  std::vector<LatticeSystem::Value> E;
  for (std::size_t n = 1; n + 1 < rows.size(); ++n) {
    const Row &below = rows[n - 1], &above = rows[n + 1];
    system.equations(system.window(0, {below, rows[n], above}, 0), 1, E);
    power.push_back(0);
    for (std::size_t at = 4; at + 3 < below.size(); at += 3)
      power.back() -= E[at].sum / h * (above[at] - below[at]) / (2 * h);
  }
  // the trapezoidal rule from row 2 to the last but one
  double work = 0.5 * h * (power.front() + power.back());
  for (std::size_t n = 1; n + 1 < power.size(); ++n) work += h * power[n];
  return {energies[energies.size() - 2] - energies[1], work};
}

}  // namespace

TEST_CASE("the energy on a mesh with a delay changes by what the mesh works, to order 2 in the step") {
  for (const char* time : {"trapezoid", "midpoint"}) {
    CAPTURE(time);
    const auto rest = [&](double h, double share) {
      const auto [change, work] = balance(time, 2, h, 1);
      return std::abs(change - share * work);
    };
    const double fine = rest(0.01, 1), order = std::log2(rest(0.02, 1) / fine);
    CHECK(order > 1.7);
    CHECK(order < 2.3);
    // not the step, but the cells, which lag behind the kink, have changed it: by a tenth
    CHECK(balance(time, 2, 0.01, 1).change > 500 * fine);
    CHECK(rest(0.01, 0.99) > 5 * fine);  // the check can fail
  }
}

TEST_CASE("the slower a mesh follows, the less it changes the energy, and not at all at rest") {
  const auto change = [](double delay, double h) { return std::abs(balance("trapezoid", delay, h, 1).change); };
  const double fast = change(16, 0.02), slow = change(64, 0.02);
  CHECK(slow < fast / 4);
  // what is left is the step's
  const double order = std::log2(change(1e9, 0.02) / change(1e9, 0.01));
  CHECK(order > 1.7);
  CHECK(order < 2.3);
  CHECK(change(1e9, 0.01) < slow / 10);
}
