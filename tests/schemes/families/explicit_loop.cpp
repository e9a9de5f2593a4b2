// SPDX-License-Identifier: MIT
#include <numbers>

#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

const std::vector<std::string> theories_of_a_loop{"sine-gordon",         "phi4", "complex-klein-gordon",
                                                  "coupled-sine-gordon", "wave", "sine-gordon-impurity"};
constexpr double k = 0.25, courant = 0.4;

Problem problem(const std::string& theory, int N, int threads = 1) {
  Problem p = problem_of(theory);
  p.lattice = Lattice::circle(N, N * k);
  p.stencil = "triangle-vertex";
  p.time_step = courant * k;
  p.threads = threads;
  return p;
}
/// Waves of a random height, and noise.
std::vector<Row> begin(const Problem& p, double amplitude = 1) {
  const int N = p.lattice.sites(), d = theory_named(p)->components();
  Random random(static_cast<std::uint64_t>(N));
  Row row, next;
  for (int i = 0; i < N * d; ++i) {
    const double height = amplitude * (std::sin(2 * std::numbers::pi * (i / d) / N) + random(-0.2, 0.2));
    const double rise = 0.02 * amplitude * random(-1, 1);
    const double wound = 2 * std::numbers::pi * p.winding * (i / d) / N;
    row.push_back(height + wound);
    next.push_back(height + wound + rise);
  }
  return {row, next};
}
Simulation started(const Problem& p) {
  Simulation simulation(p);
  simulation.start(begin(p));
  return simulation;
}
Row newest(const Simulation& simulation, int back = 0) {
  Row row(static_cast<std::size_t>(simulation.evolution().system().lattice().sites() *
                                   simulation.evolution().system().components()));
  simulation.copy_row(back, row);
  return row;
}

/// Not to be printed.
bool same(const Row& a, const Row& b) { return a == b; }

/// Whether step number n is looked at.
using Looks = bool (*)(int n);
bool always(int) { return true; }
bool never(int) { return false; }
bool every_third(int n) { return n % 3 == 2; }
bool in_pairs(int n) { return n / 2 % 2 == 0; }

/// The row after `steps`, of which the last is looked at, and the row before.
struct Rows {
  Row newest, before;
  double energy, residual;
  bool operator==(const Rows&) const = default;
};
Rows rows_after(const Problem& p, int steps, Looks looks) {
  Simulation simulation = started(p);
  for (int n = 0; n + 1 < steps; ++n) simulation.step(looks(n));
  simulation.step(true);
  return {newest(simulation), newest(simulation, 1), simulation.monitors().energy, simulation.residual()};
}

}  // namespace

TEST_CASE("rows that are not looked at are written over without a bit's difference") {
  for (const std::string& theory : theories_of_a_loop)
    for (int N : {3, 7, 8, 9, 64, 255, 1000}) {
      CAPTURE(theory, N);
      const Problem p = problem(theory, N);
      for (int steps : {2, 3, 30, 31}) {
        const Rows right = rows_after(p, steps, always);
        CHECK(std::isfinite(right.energy));
        CHECK(right.residual < 1e-14);
        CHECK(distance(right.newest, right.before) > 0);
        for (Looks looks : {never, every_third, in_pairs}) CHECK(rows_after(p, steps, looks) == right);
      }
    }
}

TEST_CASE("so it is with a winding, and with the scheme that was stepped by rows before: the equations hold") {
  for (int winding : {1, -2})
    for (int N : {9, 64, 255}) {
      CAPTURE(winding, N);
      Problem p = problem("sine-gordon", N);
      p.winding = winding;
      const Rows right = rows_after(p, 40, always);
      CHECK(right.residual < 1e-14);
      CHECK(rows_after(p, 40, never) == right);
      CHECK(rows_after(p, 40, every_third) == right);
    }
}

TEST_CASE("two and three threads make the bits of one") {
  for (const std::string theory : {"sine-gordon", "coupled-sine-gordon", "sine-gordon-impurity"})
    for (int N : {40000, 40001}) {
      const Rows right = rows_after(problem(theory, N), 25, always);
      CHECK(right.residual < 1e-14);
      for (int threads : {2, 3, 5})
        for (Looks looks : {always, never, every_third}) {
          CAPTURE(theory, N, threads);
          CHECK(rows_after(problem(theory, N, threads), 25, looks) == right);
        }
    }
}

TEST_CASE("threads make the same bits where there are not enough sites for all of them") {
  for (int N : {3, 255, 9000, 17000})
    for (int threads : {2, 3}) {
      CAPTURE(N, threads);
      CHECK(rows_after(problem("phi4", N, threads), 12, never) == rows_after(problem("phi4", N), 12, always));
    }
}

TEST_CASE("the loop agrees with the equations, one stencil at a time") {
  // The stepper holds two rows: the third of the window is kept from before.
  for (const std::string& theory : theories_of_a_loop)
    for (int N : {3, 9, 64, 73, 90, 111, 200}) {  // some packs of the longer ones go side by side, some do not
      CAPTURE(theory, N);
      const Problem p = problem(theory, N);
      Simulation simulation = started(p);
      for (int n = 0; n < 10; ++n) simulation.step(n % 2 != 0);
      const Evolution& evolution = simulation.evolution();
      Window window = evolution.stepper().window(2);
      simulation.step();
      window.rows.push_back(evolution.stepper().row(0));
      CHECK(same(evolution.stepper().row(1), window.rows[1]));
      CHECK(equation_defect(evolution, window) < 2e-15);
      window.rows[2][0] += 1e-10;
      CHECK(equation_defect(evolution, window) > 1e-13);
    }
}

TEST_CASE("the comparison of bits can fail: rows that differ in the last bit of one value, and one step more") {
  const Problem p = problem("sine-gordon", 64);
  const Rows right = rows_after(p, 30, always);
  CHECK_FALSE(rows_after(p, 31, always) == right);
  std::vector<Row> rows = begin(p);
  rows[1][17] = std::nextafter(rows[1][17], 10);
  Simulation simulation(p);
  simulation.start(rows);
  for (int n = 0; n < 30; ++n) simulation.step(n == 29);
  CHECK_FALSE(same(newest(simulation), right.newest));
}

TEST_CASE("after a row that was not looked at, the row before it is refused, not invented") {
  for (const std::string theory : {"sine-gordon", "coupled-sine-gordon"}) {
    Simulation simulation = started(problem(theory, 64));
    simulation.step();
    CHECK(std::isfinite(simulation.residual()));
    for (int n = 0; n < 3; ++n) simulation.step(false);  // now and then one may be kept
    const Stepper& stepper = simulation.evolution().stepper();
    CHECK(stepper.newest() == 5);
    CHECK_NOTHROW(stepper.row(0));
    CHECK_NOTHROW(stepper.window(1));
    CHECK_THROWS_AS(stepper.row(1), std::logic_error);
    CHECK_THROWS_AS(stepper.window(2), std::logic_error);
    CHECK_THROWS_AS(stepper.row_data(1, 0), std::logic_error);
    CHECK_THROWS_AS(newest(simulation, 1), std::logic_error);
    CHECK_THROWS_AS(simulation.monitors(), std::logic_error);
    CHECK(std::isnan(simulation.residual()));
    simulation.step();
    CHECK_NOTHROW(simulation.monitors());
    CHECK(simulation.residual() < 1e-14);
    simulation.step(false);
    simulation.start(begin(problem(theory, 64)));  // forgets it
    CHECK_NOTHROW(simulation.monitors());
    CHECK(same(stepper.row(1), begin(problem(theory, 64))[0]));
  }
}

TEST_CASE("schemes that are not one loop keep their rows, looked at or not") {
  for (const std::string stencil : {"rectangle-symmetric", "hexagon", "six-tuple", "triangle"}) {
    CAPTURE(stencil);
    Problem p = problem("sine-gordon", 64);
    p.stencil = stencil;
    Simulation simulation = started(p), looked_at = started(p);
    for (int n = 0; n < 10; ++n) simulation.step(false), looked_at.step(true);
    CHECK(same(newest(simulation), newest(looked_at)));
    CHECK(same(newest(simulation, 1), newest(looked_at, 1)));
    CHECK(simulation.residual() == looked_at.residual());
    CHECK(simulation.monitors().energy == looked_at.monitors().energy);
  }
}

TEST_CASE("on the fibre S1 a row that is not looked at is still compared with the one before it") {
  // Smooth rows for a time in which the field moves on by more than pi: what is compared must be neighbours in time.
  for (Looks looks : {always, never, every_third}) {
    Problem p = problem("sine-gordon", 64);
    p.circle_valued = true;
    p.mass = 1e-3;
    Row row(64, 0.1), next(64, 0.1 + 0.05);  // moves on by 0.05 a step
    Simulation simulation(p);
    simulation.start({row, next});
    CHECK_NOTHROW([&] {
      for (int n = 0; n < 200; ++n) simulation.step(looks(n));
    }());
  }
}

TEST_CASE("on the fibre S1 a jump is reported, whether rows are looked at or not") {
  for (bool looked_at : {true, false}) {
    CAPTURE(looked_at);
    Problem p = problem("sine-gordon", 64);
    p.circle_valued = true;
    Row row(64, 0.1), next = row;
    next[20] += 2.7;
    Simulation simulation(p);
    simulation.start({row, next});
    CHECK_THROWS_AS(
        [&] {
          for (int n = 0; n < 5; ++n) simulation.step(looked_at);
        }(),
        NotFinite);
  }
}

TEST_CASE("an overflow is reported from any row, by any number of threads, at its step and site") {
  for (int N : {64, 40000})
    for (int threads : {1, 3})
      for (bool looked_at : {true, false}) {
        CAPTURE(N, threads, looked_at);
        const Problem p = problem("phi4", N, threads);
        Row row(static_cast<std::size_t>(N), 0.1);
        row[static_cast<std::size_t>(N / 2 + 1)] = 1e3;  // the cube grows without end
        Simulation simulation(p);
        simulation.start({row, row});
        std::string message;
        int steps = 0;
        try {
          for (; steps < 100; ++steps) simulation.step(looked_at);
        } catch (const NotFinite& error) {
          message = error.what();
        }
        CHECK(contains(message, "step " + std::to_string(steps + 2) + ","));
        CHECK(contains(message, "no longer finite"));
        CHECK(contains(message, "site " + std::to_string(N / 2 + 1) + ":"));
      }
}

TEST_CASE("after an overflow the last good row is still held if steps were looked at") {
  const Problem p = problem("phi4", 64);
  Row row(64, 0.1);
  row[33] = 1e3;
  Simulation simulation(p);
  simulation.start({row, row});
  Row last, before_last;
  try {
    for (int n = 0; n < 100; ++n) {
      last = newest(simulation), before_last = newest(simulation, 1);
      simulation.step(true);
    }
  } catch (const NotFinite&) {
  }
  CHECK(same(newest(simulation), last));
  CHECK(std::ranges::all_of(last, [](double y) { return std::isfinite(y); }));
}

namespace {

/// Steps two runs, of which one looks at every row and the other as `looks` says, until the first fails; then the other
/// must fail too, at the same step, as often as it is tried. Whether what it holds is then what the first one holds, as
/// far as it holds anything: rows are refused or right.
bool holds_good_rows(const Problem& p, const std::vector<Row>& start, Looks looks, int most_steps = 20000) {
  Simulation simulation(p), looked_at(p);
  for (Simulation* s : {&simulation, &looked_at}) s->start(start);
  bool failed = false;
  int n = 0;
  for (; n < most_steps && !failed; ++n) {
    try {
      looked_at.step();
    } catch (const NotFinite&) {
      failed = true;
    }
    if (!failed) simulation.step(looks(n));
  }
  REQUIRE(failed);
  CHECK_THROWS_AS(looked_at.step(), NotFinite);
  const Stepper &stepper = simulation.evolution().stepper(), &right = looked_at.evolution().stepper();
  bool good = true;
  for (int attempt = 0; attempt < 4; ++attempt) {
    CHECK_THROWS_AS(simulation.step(attempt % 2 != 0), NotFinite);
    good = good && stepper.newest() == right.newest();
    for (int back : {0, 1, 2}) {
      try {
        good = good && stepper.row(back) == right.row(back);
      } catch (const std::logic_error&) {
        good = good && back > 0;
      }
    }
    try {
      const double energy = simulation.monitors().energy, expected = looked_at.monitors().energy;
      good = good && (energy == expected || (std::isnan(energy) && std::isnan(expected)));  // squares overflow early
    } catch (const std::logic_error&) {
    }
  }
  return good;
}
std::vector<Row> one_high(int N, double height) {
  Row row(static_cast<std::size_t>(N), 0.1);
  row[static_cast<std::size_t>(N / 2 + 1)] = height;
  return {row, row};
}
bool one_looked_at_first(int n) { return n == 0; }
bool every_other(int n) { return n % 2 == 0; }

}  // namespace

TEST_CASE("after an overflow what is held is the last good rows, whether they were looked at or not") {
  for (double height : {300.0, 1e3, 1e7})
    for (int N : {9, 64})
      for (Looks looks : {always, never, one_looked_at_first, every_other, every_third, in_pairs}) {
        CAPTURE(height, N);
        CHECK(holds_good_rows(problem("phi4", N), one_high(N, height), looks));
      }
  CHECK(holds_good_rows(problem("phi4", 40000, 3), one_high(40000, 1e3), never));
}

TEST_CASE("so it is for an overflow after thousands of steps") {
  for (double above : {0.01, 0.001}) {
    CAPTURE(above);
    Problem p = problem("wave", 64);
    p.time_step = (1 + above) * k;
    for (Looks looks : {never, every_third}) CHECK(holds_good_rows(p, begin(p), looks));
  }
}

TEST_CASE("what a run kept for the case of an overflow is forgotten when it is started anew") {
  const Problem p = problem("phi4", 64);
  Simulation simulation(p), fresh(p);
  simulation.start(begin(p, 0.1));
  for (int n = 0; n < 3000; ++n) simulation.step(false);
  for (Simulation* s : {&simulation, &fresh}) {
    s->start(one_high(64, 1e3));
    CHECK_THROWS_AS(
        [&] {
          for (int n = 0; n < 100; ++n) s->step(s == &fresh);
        }(),
        NotFinite);
  }
  CHECK(simulation.newest() == fresh.newest());
  CHECK(same(newest(simulation), newest(fresh)));
}

TEST_CASE("after a jump on the fibre S1 the rows before it are held, looked at or not") {
  Problem p = problem("sine-gordon", 64);
  p.circle_valued = true;
  Row row(64, 0.1), next = row;
  next[20] += 2.7;
  for (Looks looks : {always, never, every_other}) CHECK(holds_good_rows(p, {row, next}, looks, 50));
}
