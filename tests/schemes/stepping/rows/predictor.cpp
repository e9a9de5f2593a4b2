// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/predictor.hpp"

#include <cmath>

#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr int most_rows = 8;
constexpr double time_step = 0.1;

/// Source terms of past rows that are polynomials in time, another one at each site.
struct Past {
  Evolution evolution;
  RowLayout layout;
  RowTable table;
  RowEquations equations;
  Predictor predictor;

  Past(const std::string& stencil, int N)
      : evolution(evolution_of(problem_of("sine-gordon"), stencil, Lattice::circle(N, 0.25 * N), time_step)),
        layout(evolution.system().lattice(), std::max(1, evolution.system().width()), stencil == "hexagon" ? 2 : 1),
        equations(evolution.system(), evolution.plan(), layout, table, 2, most_rows),
        predictor(equations, layout, most_rows) {}

  /// Whole numbers, so that differences are exact: Σ_p c_p jᵖ at row n + 1 − j, site v of the lane.
  static double value(int degree, int j, int slot) {
    double sum = 0;
    for (int p = 0; p <= degree; ++p) sum += (1 + (slot + p) % 3) * std::pow(j, p);
    return sum;
  }
  void fill(int degree) {
    for (const SourceRow& source : equations.sources())
      for (int number = 1; number < source.ring.held; ++number)  // of bricks every second row stands at the same sites
        for (std::size_t i = 0; i < layout.doubles(); ++i)
          table[source.ring.row(number)][i] =
              value(degree, (number + source.stride - 1) / source.stride, static_cast<int>(i));
  }
  void choose(double contraction, double allowed, int rows = most_rows, std::int64_t n = 100) {
    predictor.choose(table, n, rows, std::vector<double>(equations.sources().size(), 1.0), contraction, allowed, time_step);
  }
  /// How far the prediction of the next row is off, over all source terms.
  double error(int degree) {
    double worst = 0;
    for (std::size_t s = 0; s < equations.sources().size(); ++s) {
      const SourceRow& source = equations.sources()[s];
      equations.prediction(source, predictor.order())
          .evaluate(table.data(), layout.at(0), layout.at(layout.packs()), lanes, table[source.ring.row(0)]);
      for (auto at = layout.at(0); at < layout.at(layout.packs()); ++at)
        worst = std::max(worst, std::abs(table[equations.sources()[s].ring.row(0)][at] -
                                         value(degree, 0, static_cast<int>(at))));
    }
    return worst;
  }
};

}  // namespace

TEST_CASE("the order is chosen that predicts a polynomial, and predicts it exactly") {
  for (const char* stencil : {"rectangle", "nine-tuple", "hexagon"})
    for (int degree = 0; degree <= 6; ++degree) {
      CAPTURE(stencil, degree);
      Past past(stencil, 66);
      past.fill(degree);
      past.choose(0.3, 1e-10);
      CHECK(past.predictor.order() == degree + 1);
      CHECK(past.error(degree) == 0);
      past.fill(degree + 1);
      CHECK(past.error(degree + 1) > 0.5);  // of a degree more
    }
}

TEST_CASE("an order is good until it is due, and of a new start it is one") {
  Past past("rectangle", 40);
  past.fill(4);
  CHECK(past.predictor.order() == 1);
  past.choose(0.3, 1e-10, most_rows, 100);
  CHECK(past.predictor.order() == 5);
  CHECK_FALSE(past.predictor.is_due(101));
  CHECK(past.predictor.is_due(10000));
  past.predictor.restart();
  CHECK(past.predictor.order() == 1);
  CHECK(past.predictor.is_due(0));
}

TEST_CASE("no more rows are extrapolated from than are there, and all of them where iterations do not contract") {
  for (int rows = 1; rows <= most_rows; ++rows) {
    Past past("rectangle", 40);
    past.fill(7);
    past.choose(0.9, 1e-10, rows);
    CHECK(past.predictor.order() == rows);
    past.choose(0.3, 1e-10, rows);
    CHECK(past.predictor.order() <= rows);
    // While rows are still to come the choice is made anew at each step.
    CHECK(past.predictor.is_due(101) == (rows < most_rows));
  }
}

TEST_CASE("where a few iterations are cheap a lower order is enough") {
  Past past("rectangle", 40);
  past.fill(9);  // no order is exact
  past.choose(1e-9, 1e-3);  // two iterations whatever the order
  CHECK(past.predictor.order() == 4);
}

TEST_CASE("few rows are kept of fields that are larger than the cache") {
  CHECK(Predictor::rows_for(8, 255) == 8);
  CHECK(Predictor::rows_for(3, 255) == 3);
  CHECK(Predictor::rows_for(0, 255) == 1);
  CHECK(Predictor::rows_for(20, 255) == 8);
  CHECK(Predictor::rows_for(8, 1000000) == 3);
}
