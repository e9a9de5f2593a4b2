// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/time_tiles.hpp"

#include <numbers>

#include "schemes/scheme.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double k = 0.25;
/// Long enough on every instruction set: 8192 packs of eight lanes and more.
constexpr int long_row = 8192 * 8;

Problem problem(const std::string& theory, int N, int threads, double courant) {
  Problem p = problem_of(theory);
  p.lattice = Lattice::circle(N, N * k);
  p.stencil = "triangle-vertex";
  p.time_step = courant * k;
  p.threads = threads;
  return p;
}
/// Waves and noise.
std::vector<Row> begin(int N, int d, double amplitude = 1) {
  Random random(4);
  std::vector<Row> rows(2);
  for (int i = 0; i < N * d; ++i) {
    const double y = amplitude * (std::sin(200 * std::numbers::pi * (i / d) / N) + random(-0.2, 0.2));
    rows[0].push_back(y);
    rows[1].push_back(y + 0.02 * amplitude * random(-1, 1));
  }
  return rows;
}

struct State {
  std::int64_t newest;
  Row row, before;
  double energy;
  std::string failure;
  bool operator==(const State&) const = default;
};
/// Groups of steps that no one looks at, with one that is looked at after each.
State after(const Problem& p, const std::vector<int>& groups, bool together, double amplitude = 1, double off = 0) {
  Simulation simulation(p);
  const int N = p.lattice.sites(), d = simulation.theory().components();
  CHECK(simulation.steps_at_once() == TimeTiles::most_levels);
  std::vector<Row> start = begin(N, d, amplitude);
  start[1][static_cast<std::size_t>(N * d / 2)] += off;
  simulation.start(start);
  State state;
  try {
    for (const int count : groups) {
      if (together) simulation.steps(count);
      else
        for (int n = 0; n < count; ++n) simulation.step(true);
      simulation.step(true);
    }
  } catch (const NotFinite& failure) {
    state.failure = failure.what();
  }
  state.newest = simulation.newest();
  state.row.resize(static_cast<std::size_t>(N * d));
  state.before = state.row;
  simulation.copy_row(0, state.row);
  simulation.copy_row(1, state.before);
  state.energy = state.failure.empty() ? simulation.monitors().energy : 0;
  return state;
}

const std::vector<int> groups{1, 2, 40, 0, 17, 5};

/// The discrete d'Alembertian by sites two apart, one quadrature point at each vertex: neighbours reach further.
struct Wide {
  static constexpr JetTable<3, 1> table{
      Offsets<3>{{{{0, 0}, {1, 0}, {0, 2}}}}, 1, {{{1, {1, 0, 0}, {-1, 1, 0}, {-.5, 0, .5}}}}};
};

}  // namespace

TEST_CASE("steps that are taken together have the bits of those that are looked at one by one") {
  for (const std::string theory : {"sine-gordon", "coupled-sine-gordon", "sine-gordon-impurity"})
    for (const int past : {0, 3, 6}) {
      CAPTURE(theory, past);
      const Problem p = problem(theory, long_row + past, 1, 0.4);
      CHECK((after(p, groups, true) == after(p, groups, false)));
    }
}

TEST_CASE("so have those that threads share") {
  const State alone = after(problem("sine-gordon", long_row + 5, 1, 0.4), groups, false);
  for (const int threads : {2, 3}) {
    const Problem p = problem("sine-gordon", long_row + 5, threads, 0.4);
    CHECK((after(p, groups, true) == alone));
    CHECK((after(p, groups, false) == alone));
  }
}

TEST_CASE("the comparison can fail: one site that is off by rounding") {
  const Problem p = problem("sine-gordon", long_row, 1, 0.4);
  CHECK_FALSE((after(p, groups, true, 1, 1e-15) == after(p, groups, false)));
}

TEST_CASE("neighbours that reach further are taken together too") {
  const Lattice ring = Lattice::circle(long_row + 3, (long_row + 3) * k);
  const std::vector<Row> start = begin(ring.sites(), 1);
  Evolution together = Scheme{Wide{}, SineGordon{}}.on(ring, 0.4 * k),
            alone = Scheme{Wide{}, SineGordon{}}.on(ring, 0.4 * k);
  CHECK(together.stepper().steps_at_once() == TimeTiles::most_levels);
  for (Evolution* evolution : {&together, &alone}) evolution->stepper().start(start);
  together.stepper().steps(50);
  for (int n = 0; n < 50; ++n) alone.stepper().step(true);
  CHECK((together.stepper().row(0) == alone.stepper().row(0)));
}

TEST_CASE("a field that overflows among steps that are taken together ends as one that is looked at") {
  const Problem p = problem("sine-gordon", long_row, 1, 1.3);
  const State together = after(p, std::vector<int>(40, 50), true, 1e60),
              alone = after(p, std::vector<int>(40, 50), false, 1e60);
  CHECK(contains(together.failure, "no longer finite"));
  CHECK(together.failure == alone.failure);
  CHECK_FALSE(contains(alone.failure, "site " + std::to_string(long_row)));  // they count from 0
  CHECK(together.newest == alone.newest);
  CHECK((together.row == alone.row));
  CHECK((together.before == alone.before));
}

TEST_CASE("a field that outgrows what is near among steps that are taken together goes on with the same bits") {
  const Problem p = problem("sine-gordon", long_row, 1, 1.1);
  // 2 10⁶ sites' worth of squares are near up to a mean of 4e3: unstable waves grow through that.
  const State together = after(p, groups, true, 1), alone = after(p, groups, false, 1);
  double largest = 0;
  for (double y : together.row) largest = std::max(largest, std::abs(y));
  CHECK(largest > 1e6);
  CHECK((together == alone));
}

TEST_CASE("rows that stay in the cache, and those of a winding field, are stepped one by one") {
  const Simulation shorter(problem("sine-gordon", 4096, 1, 0.4)), longer(problem("sine-gordon", long_row, 1, 0.4));
  CHECK(shorter.steps_at_once() == 1);
  CHECK_FALSE(contains(shorter.plan_report(), "at once"));
  CHECK(contains(longer.plan_report(), "16 at once"));
  Problem wound = problem("sine-gordon", long_row, 1, 0.4);
  wound.winding = 1;
  CHECK(Simulation(wound).steps_at_once() == 1);
  Problem implicit = problem("sine-gordon", long_row, 1, 0.4);
  implicit.stencil = "rectangle";
  CHECK(Simulation(implicit).steps_at_once() == 1);
}
