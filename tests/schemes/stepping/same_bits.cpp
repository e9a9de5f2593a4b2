// SPDX-License-Identifier: MIT
#include <numbers>

#include "lattice/index.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// What a run leaves: rows, energies and how often it iterated.
struct Trace {
  std::vector<Row> rows;
  std::vector<double> energies;
  int iterations = 0;
  bool operator==(const Trace&) const = default;
};

struct Asked {
  bool residual = false, monitors = true, rows = true;
  int threads = 1;
};

Trace run(const std::string& theory, const std::string& scheme, const Asked& asked, double off = 0) {
  Problem p = problem_of(theory);
  const int N = 66;
  p.lattice = Lattice::circle(N, N * 0.25);
  p.time_step = 0.1;
  p.tolerance = 1e-10;
  p.threads = asked.threads;
  if (scheme == "guo" || scheme == "vu-quoc-li") p.method = scheme;
  else p.stencil = scheme;
  Simulation simulation(p);
  const int d = simulation.theory().components();
  std::vector<Row> start;
  for (int n = 0; n < simulation.starting_rows(); ++n) {
    start.emplace_back();
    for (int i = 0; i < N * d; ++i)
      start.back().push_back(std::sin(2 * std::numbers::pi * (i / d) / N) + 0.02 * n * std::cos(i) + 0.1 * (i % d));
  }
  start.back()[3] += off;
  simulation.start(start);
  Trace trace;
  Row row(at(N * d));
  for (int n = 0; n < 150; ++n) {
    simulation.step();
    if (asked.residual) CHECK(simulation.residual() < 1e-8);
    trace.iterations += simulation.iterations();
    if (n % 50 != 49 && !asked.rows) continue;
    simulation.copy_row(0, row);
    if (asked.monitors) {
      const double energy = simulation.monitors().energy;
      if (n % 50 == 49) trace.energies.push_back(energy);
    } else if (n % 50 == 49) {
      trace.energies.push_back(simulation.monitors().energy);
    }
    if (n % 50 == 49) trace.rows.push_back(row);
  }
  return trace;
}

std::vector<std::string> schemes_of(const std::string& theory) {
  std::vector<std::string> schemes = stencil_names();
  for (const char* comparator : {"guo", "vu-quoc-li"})
    if (family_of(problem_of(theory), comparator)) schemes.emplace_back(comparator);
  return schemes;
}
const std::vector<std::string> some_theories{"sine-gordon", "phi4", "coupled-sine-gordon", "sine-gordon-impurity"};

}  // namespace

TEST_CASE("two runs make the same bits, with every stencil") {
  for (const std::string& theory : some_theories)
    for (const std::string& scheme : schemes_of(theory)) {
      CAPTURE(theory, scheme);
      const Trace first = run(theory, scheme, {});
      CHECK(first.rows.size() == 3);
      CHECK(std::isfinite(first.energies.back()));
      CHECK(run(theory, scheme, {}) == first);
      CHECK(run(theory, scheme, {.threads = 3}) == first);
    }
}

TEST_CASE("a run does not depend on what it is asked between its steps") {
  for (const std::string& theory : some_theories)
    for (const std::string& scheme : schemes_of(theory)) {
      CAPTURE(theory, scheme);
      const Trace quiet = run(theory, scheme, {.residual = false, .monitors = false, .rows = false});
      CHECK(run(theory, scheme, {.residual = true, .monitors = true, .rows = true}) == quiet);
      CHECK(run(theory, scheme, {.residual = true, .monitors = false, .rows = false}) == quiet);
    }
}

TEST_CASE("a run started anew in the same simulation makes the bits of a fresh one") {
  for (const std::string& scheme : schemes_of("sine-gordon")) {
    CAPTURE(scheme);
    const Lattice circle = Lattice::circle(34, 8);
    Evolution used = evolution_of(problem_of("sine-gordon"), scheme, circle, 0.1);
    Evolution fresh = evolution_of(problem_of("sine-gordon"), scheme, circle, 0.1);
    Random random(9);
    const int rows = used.stepper().starting_rows();
    const auto first = random_rows(random, rows, 34, 0.5), start = random_rows(random, rows, 34, 1);
    used.stepper().start(first);
    for (int n = 0; n < 77; ++n) used.stepper().step(n % 2 == 0);
    used.stepper().start(start);
    fresh.stepper().start(start);
    for (int n = 0; n < 40; ++n) used.stepper().step(), fresh.stepper().step();
    CHECK(used.stepper().row(0) == fresh.stepper().row(0));
    CHECK(used.stepper().row(1) == fresh.stepper().row(1));
    CHECK(used.stepper().residual() == fresh.stepper().residual());
  }
}

TEST_CASE("the comparison of runs can fail: a start that differs by rounding") {
  for (const std::string& scheme : schemes_of("phi4")) {
    CAPTURE(scheme);
    CHECK_FALSE(run("phi4", scheme, {}, 1e-15) == run("phi4", scheme, {}));
  }
}
