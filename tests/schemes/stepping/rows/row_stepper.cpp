// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/row_stepper.hpp"

#include <numbers>

#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double h = 0.1, k = 0.25;

std::vector<std::string> schemes_of(const std::string& theory) {
  std::vector<std::string> schemes = stencil_names();
  for (const char* comparator : {"guo", "vu-quoc-li"})
    if (family_of(problem_of(theory), comparator)) schemes.emplace_back(comparator);
  return schemes;
}

/// A smooth wave, and the rows after it by a small phase.
std::vector<Row> waves(int count, int N, int d) {
  std::vector<Row> rows;
  for (int j = 0; j < count; ++j) {
    rows.emplace_back();
    for (int i = 0; i < N * d; ++i)
      rows.back().push_back(1.5 * std::sin(2 * std::numbers::pi * 3 * (i / d) / N - 0.01 * j) + 0.1 * (i % d) +
                            0.05 * std::cos(2.1 * i));
  }
  return rows;
}

void check_equations(Evolution evolution, double rows_amplitude, int steps = 3) {
  Stepper& stepper = evolution.stepper();
  const int N = evolution.system().lattice().sites(), d = evolution.system().components();
  Random random(47);
  stepper.start(random_rows(random, stepper.starting_rows(), N * d, rows_amplitude));
  for (int n = 0; n < steps; ++n) stepper.step();
  REQUIRE(stepper.layout());
  CHECK(equation_defect(evolution, window_of(evolution)) < 1e-14);
  CHECK(stepper.residual() < 1e-14);
}

}  // namespace

TEST_CASE("steps by rows solve the equations at every site, for every theory, scheme and number of sites") {
  for (const std::string theory : {"sine-gordon", "phi4", "double-sine-gordon", "sine-gordon-impurity",
                                   "coupled-sine-gordon", "complex-klein-gordon", "klein-gordon", "wave"})
    for (const std::string& scheme : schemes_of(theory))
      for (int N : {2, 3, 15, 16, 17, 31, 33, 63, 64, 127, 129, 255, 513}) {
        if (scheme == "hexagon" && (N % 2 != 0 || N == 2)) continue;
        CAPTURE(theory, scheme, N);
        check_equations(evolution_of(problem_of(theory), scheme, Lattice::circle(N, N * k), h), 0.8, 2);
      }
}

TEST_CASE("and between walls") {
  for (const std::string theory : {"sine-gordon", "sine-gordon-impurity", "coupled-sine-gordon"})
    for (const std::string& scheme : schemes_of(theory))
      for (int N : {4, 15, 17, 33, 64, 129, 513}) {
        if (scheme == "hexagon") continue;  // slab by slab
        CAPTURE(theory, scheme, N);
        check_equations(evolution_of(problem_of(theory), scheme, Lattice::interval(N, (N - 1) * k), h), 0.8, 2);
      }
}

TEST_CASE("rows that are stepped strip by strip solve the equations at every site, at the seams of strips too") {
  for (const std::string theory : {"sine-gordon", "coupled-sine-gordon"})
    for (const std::string& scheme : schemes_of(theory))
      for (int N : {4097, 5120 * lanes - 5}) {
        if (theory == "coupled-sine-gordon" && N > 5000) continue;
        const int sites = scheme == "hexagon" ? N / 2 * 2 : N;
        CAPTURE(theory, scheme, sites);
        check_equations(evolution_of(problem_of(theory), scheme, Lattice::circle(sites, sites * k), h), 0.8, 2);
      }
}

TEST_CASE("a step to the default tolerance ends where its root cannot be told from it") {
  const Lattice lattice = Lattice::circle(64, 64 * k);
  for (const std::string scheme : {"rectangle-symmetric", "triangle", "rectangle"}) {
    const auto stepped = [&](double tolerance) {
      StepOptions options;
      options.tolerance = tolerance;
      Evolution evolution = evolution_of(problem_of("sine-gordon"), scheme, lattice, h, options);
      Stepper& stepper = evolution.stepper();
      stepper.start(waves(stepper.starting_rows(), 64, 1));
      for (int n = 0; n < 40; ++n) stepper.step();
      // From rows alone a step has no source terms to predict from: it takes another way to the root.
      Evolution other = evolution_of(problem_of("sine-gordon"), scheme, lattice, h, options);
      other.stepper().start({stepper.row(2), stepper.row(1)});
      other.stepper().step();
      double apart = 0;
      for (int i = 0; i < 64; ++i)
        apart = std::max(apart, std::abs(other.stepper().row(0)[at(i)] - stepper.row(0)[at(i)]));
      return std::pair{apart, stepper.iterations()};
    };
    const auto [rounding, solves] = stepped(1e-14);
    const auto [left, few] = stepped(1e-7);
    CAPTURE(scheme, rounding, solves, left, few);
    CHECK(rounding < 4e-15);  // of fields up to 1.5
    CHECK(left > 1e-12);
    CHECK(few < solves);
  }
}

TEST_CASE("a step in place has the bits of one beside, whatever the length of rows") {
  for (const std::string theory : {"sine-gordon", "coupled-sine-gordon", "sine-gordon-impurity"})
    for (const std::string scheme : {"triangle-vertex", "triangle", "rectangle", "rectangle-symmetric", "six-tuple"})
      for (int N : {17, 255, 600 * lanes + 3, 5120 * lanes - 5}) {
        CAPTURE(theory, scheme, N);
        Evolution in_place = evolution_of(problem_of(theory), scheme, Lattice::circle(N, N * k), h),
                  beside = evolution_of(problem_of(theory), scheme, Lattice::circle(N, N * k), h);
        const auto start = waves(2, N, in_place.system().components());
        in_place.stepper().start(start), beside.stepper().start(start);
        in_place.stepper().steps(7);
        in_place.stepper().step(false);
        for (int n = 0; n < 8; ++n) beside.stepper().step();
        CHECK(in_place.stepper().newest() == beside.stepper().newest());
        CHECK(in_place.stepper().row(0) == beside.stepper().row(0));
        in_place.stepper().step(), beside.stepper().step();
        CHECK(in_place.stepper().row(0) == beside.stepper().row(0));
        CHECK(in_place.stepper().row(1) == beside.stepper().row(1));
        CHECK(in_place.stepper().residual() == beside.stepper().residual());
      }
}

TEST_CASE("recurrences along a long row of a linear theory are the same for any number of threads") {
  const int N = 5120 * lanes - 5;  // threads that shared them wrote beyond their rows
  std::vector<std::vector<double>> rows;
  for (const int threads : {1, 3}) {
    StepOptions options;
    options.threads = threads;
    Evolution evolution =
        evolution_of(problem_of("wave"), "rectangle-symmetric", Lattice::circle(N, N * k), h, options);
    evolution.stepper().start(waves(2, N, 1));
    evolution.stepper().steps(3);
    rows.push_back(evolution.stepper().row(0));
  }
  CHECK(rows[0] == rows[1]);
}

TEST_CASE("a step in place leaves no row before it, and no residual") {
  const int N = 5120 * lanes - 5;
  for (const std::string scheme : {"triangle-vertex", "rectangle-symmetric"}) {
    CAPTURE(scheme);
    Evolution evolution = evolution_of(problem_of("sine-gordon"), scheme, Lattice::circle(N, N * k), h);
    evolution.stepper().start(waves(2, N, 1));
    evolution.stepper().steps(3);
    CHECK_THROWS_AS(evolution.stepper().row(1), std::logic_error);
    CHECK(std::isnan(evolution.stepper().residual()));
    evolution.stepper().step();
    CHECK_NOTHROW(evolution.stepper().row(1));
    CHECK(evolution.stepper().residual() < 1e-14);
  }
}

TEST_CASE("steps that overflow go back: the newest row is the last finite one, as by steps beside") {
  for (int N : {64, 5120 * lanes - 6}) {
    const auto unstable = [&] {
      return evolution_of(problem_of("phi4"), "triangle-vertex", Lattice::circle(N, N * 0.05), h);
    };
    Evolution in_place = unstable(), beside = unstable();
    auto start = waves(2, N, 1);
    for (Row& row : start) row[N / 3] += 1;
    in_place.stepper().start(start), beside.stepper().start(start);
    const auto message = [](const auto& run) {
      try {
        run();
      } catch (const NotFinite& error) {
        return std::string(error.what());
      }
      return std::string();
    };
    const std::string by_steps = message([&] { in_place.stepper().steps(400); });
    const std::string one_by_one = message([&] {
      for (int n = 0; n < 400; ++n) beside.stepper().step();
    });
    CAPTURE(N, by_steps);
    CHECK(contains(one_by_one, "no longer finite"));
    CHECK(by_steps == one_by_one);
    CHECK(in_place.stepper().newest() == beside.stepper().newest());
    CHECK(in_place.stepper().row(0) == beside.stepper().row(0));
    CHECK(in_place.stepper().row(1) == beside.stepper().row(1));
    // It is as before the step: again, it throws the same.
    CHECK(message([&] { in_place.stepper().step(); }) == one_by_one);
  }
}

TEST_CASE("threads leave the bits as they are") {
  struct Case {
    const char *theory, *scheme;
    int sites;
  };
  for (const auto& [theory, scheme, N] :
       {Case{"sine-gordon", "triangle-vertex", 2500 * lanes + 3},
        Case{"sine-gordon", "triangle-vertex", 5120 * lanes - 5},
        Case{"coupled-sine-gordon", "triangle-vertex", 5120 * lanes - 5},
        Case{"sine-gordon", "triangle", 5120 * lanes - 5}, Case{"coupled-sine-gordon", "hexagon", 2500 * lanes},
        Case{"sine-gordon", "rectangle-symmetric", 9000 * lanes - 5},
        Case{"coupled-sine-gordon", "rectangle-symmetric", 8200 * lanes + 1},
        Case{"sine-gordon", "guo", 5120 * lanes}}) {
    const auto run = [&](int threads, bool looked_at) {
      StepOptions options;
      options.threads = threads;
      options.tolerance = 1e-14;
      Evolution evolution = evolution_of(problem_of(theory), scheme, Lattice::circle(N, N * k), h, options);
      evolution.stepper().start(waves(2, N, evolution.system().components()));
      for (int n = 0; n < 6; ++n) evolution.stepper().step(looked_at);
      return evolution.stepper().row(0);
    };
    CAPTURE(theory, scheme, N);
    const Row alone = run(1, true);
    for (int threads : {2, 3}) {
      CHECK(run(threads, true) == alone);
      CHECK(run(threads, false) == alone);
    }
  }
}
