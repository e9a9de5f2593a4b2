// SPDX-License-Identifier: MIT
#include "schemes/families/division_loop.hpp"

#include "schemes/stepping/rows/argument_rows.hpp"
#include "schemes/stepping/rows/extrapolation.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double h = 0.2, k = 0.3;
constexpr int halo = 2;

/// From one pack on, less than a few that go side by side, just as many, and some more.
const std::vector<int> sizes{6, 11, 20, 29, 36, 61, 70, 83, 104};
std::vector<std::pair<int, int>> every_pair(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<std::pair<int, int>> pairs;
  for (const int x : a)
    for (const int y : b) pairs.emplace_back(x, y);
  return pairs;
}

/// A step of division of a scheme, from random rows with random coefficients. What is extrapolated is no larger than 1.
struct RandomDivision {
  int N;
  Lattice lattice = Lattice::circle(N, N * k);
  Evolution evolution;
  const RowKernel& kernel;
  RowLayout layout{lattice, halo};
  int parts, old;
  RowBuffer y{layout, 1}, v{layout, 1}, past{layout, most_past_rows_divided}, argument{layout, 1}, known{layout, 1},
      old_output{layout, 1}, output{layout, 1}, y_new{layout, 1}, v_new{layout, 1};
  std::vector<const double*> past_rows_of_seed;
  DivisionRows rows{};
  RowIncrement increment{};

  RandomDivision(const std::string& scheme, int past_rows, int sites = 61)
      : N(sites),
        evolution(evolution_of(problem_of("sine-gordon"), scheme, lattice, h)),
        kernel(*evolution.system().families()[0]->row_kernel()),
        parts(scheme == "triangle" ? 2 : 1),
        old(scheme == "triangle" ? 2 : 0) {
    Random random(7);
    for (RowBuffer* row : {&y, &v, &past, &argument, &known, &old_output})
      for (int r = 0; r < row->rows(); ++r)
        layout.scatter(random_rows(random, 1, N, row == &past ? std::exp2(-past_rows) : 1)[0], row->row(r));
    for (int j = 0; j < past_rows; ++j) past_rows_of_seed.push_back(past.row((j + 1) % past.rows()));
    rows = {.arguments = {.layout = &layout,
                          .unknown = argument.row(0),
                          .known = known.row(0),
                          .known_weight = 0.3,
                          .t = 1.1,
                          .time_step = h,
                          .space_step = k,
                          .past_rows = past_rows,
                          .past = past_rows_of_seed.data(),
                          .read_before = halo,
                          .read_after = halo},
            .y = y.row(0),
            .old_output = old_output.row(0),
            .output = output.row(0),
            .constant = random(-1, 1),
            .of_neighbours = random(-1, 1),
            .of_outputs = random(-1, 1)};
    increment = {v.row(0), y.row(0), v_new.row(0), y_new.row(0), {}};
    increment.look.argument = argument.row(0);
    increment.look.parts = parts;
    for (int p = 0; p < parts; ++p) increment.look.weights[p] = 0.5 - 0.2 * p;
  }

  /// What is extrapolated of the argument at a slot.
  double extrapolated(std::ptrdiff_t at) {
    const int count = static_cast<int>(past_rows_of_seed.size());
    if (count == 0) return argument.row(0)[at];
    double u = 0;
    for (int j = 1; j <= count; ++j) u += extrapolation_weight(count, j) * past_rows_of_seed[j - 1][at];
    return u;
  }
};

}  // namespace

TEST_CASE("a division's loop evaluates, sums, makes the new row and looks at it as its formula says") {
  for (const std::string scheme : {"triangle", "guo"})
    for (const auto& [past_rows, sites] : every_pair({0, 2, 3, 4, most_past_rows_divided}, sizes)) {
      CAPTURE(scheme, past_rows, sites);
      RandomDivision given(scheme, past_rows, sites);
      const RowLayout& layout = given.layout;
      REQUIRE(given.kernel.divides(given.old, given.parts));
      // The outputs by the loop that does nothing else.
      RowBuffer u(layout, 1), E(layout, 1);
      const auto begin = layout.at(0), end = layout.at(layout.packs());
      for (auto at = begin; at < end; ++at) u.row(0)[at] = given.extrapolated(at);
      ArgumentRow apart = given.rows.arguments;
      apart.unknown = u.row(0), apart.past_rows = 0;
      given.kernel.evaluate_arguments(apart, E.row(0), layout.all());

      const RowChange all = given.kernel.divide(given.rows, given.increment);
      double worst = 0, largest = 0, change = 0;
      const auto hold = [&](double found, double expected) { worst = std::max(worst, std::abs(found - expected)); };
      const double* const y = given.y.row(0);
      const double* const old_row = given.old_output.row(0);
      for (auto at = begin; at < end; ++at) {
        const DivisionRows& r = given.rows;
        double w = r.constant + r.of_neighbours * (y[at + lanes] - 2 * y[at] + y[at - lanes]) +
                   r.of_outputs * E.row(0)[at];
        if (given.old > 0) w += r.of_outputs * (old_row[at] + old_row[at - lanes]);
        hold(given.output.row(0)[at], E.row(0)[at]);
        hold(given.v_new.row(0)[at], given.v.row(0)[at] + w);
        hold(given.y_new.row(0)[at], y[at] + given.v.row(0)[at] + w);
        largest = std::max(largest, std::abs(given.y_new.row(0)[at]));
        double look = 0;
        for (int p = 0; p < given.parts; ++p)
          look += given.increment.look.weights[p] * given.y_new.row(0)[at + p * lanes];
        hold(given.argument.row(0)[at], look);
        change = std::max(change, std::abs(look - u.row(0)[at]));
      }
      layout.fill_halo(E.row(0));
      for (std::size_t s = 0; s < layout.doubles(); ++s) hold(given.output.row(0)[s], E.row(0)[s]);
      CHECK(worst < 1e-14);
      CHECK(all.largest == largest);
      CHECK(all.change == Approx(change).epsilon(1e-14));
    }
}

TEST_CASE("along straight lines a division's loop does the same without rows of the argument, and in place") {
  for (const std::string scheme : {"triangle", "guo"})
    for (const auto& [form, sites] : every_pair({0, 1, 2, 3}, sizes)) {
      const double known_increment = form % 2;
      const bool near = form >= 2;
      if (scheme == "triangle" && known_increment != 0) continue;
      CAPTURE(scheme, sites, known_increment, near);
      RandomDivision apart(scheme, 0, sites), beside(scheme, 0, sites), over(scheme, 0, sites);
      const RowLayout& layout = apart.layout;
      // Rows of the argument, by its formula.
      for (auto at = layout.at(0); at < layout.at(layout.packs()); ++at) {
        const double *y = apart.y.row(0) + at, *v = apart.v.row(0) + at;
        apart.argument.row(0)[at] = 0;
        for (int p = 0; p < apart.parts; ++p)
          apart.argument.row(0)[at] += apart.increment.look.weights[p] * (y[p * lanes] + v[p * lanes]);
        apart.known.row(0)[at] = y[0] - known_increment * v[0];
      }
      const RowChange expected = apart.kernel.divide(apart.rows, apart.increment);

      for (RandomDivision* given : {&beside, &over}) {
        given->rows.arguments.near = near;
        given->rows.arguments.known = given->y.row(0);
        given->rows.known_increment = known_increment;
      }
      over.rows.output = over.old_output.row(0);
      over.increment.v = over.v.row(0), over.increment.y = over.y.row(0);
      const RowChange found = beside.kernel.divide_straight(beside.rows, beside.increment);
      const RowChange in_place = over.kernel.divide_straight(over.rows, over.increment);
      double worst = 0, difference = 0, w = 0, weights = 0;
      for (int p = 0; p < apart.parts; ++p) weights += std::abs(apart.increment.look.weights[p]);
      const auto hold = [&](RowBuffer& right, RowBuffer& there, RowBuffer& there_in_place, std::ptrdiff_t at) {
        worst = std::max(worst, std::abs(right.row(0)[at] - there.row(0)[at]));
        difference = std::max(difference, std::abs(there.row(0)[at] - there_in_place.row(0)[at]));
      };
      for (auto at = layout.at(0); at < layout.at(layout.packs()); ++at) {
        hold(apart.y_new, beside.y_new, over.y, at);
        hold(apart.v_new, beside.v_new, over.v, at);
        hold(apart.output, beside.output, over.old_output, at);
        w = std::max(w, std::abs(beside.v_new.row(0)[at] - beside.v.row(0)[at]));
      }
      CHECK(worst < 1e-14);
      CHECK(difference == 0);
      CHECK(found.largest == Approx(expected.largest).epsilon(1e-14));
      CHECK(found.change == Approx(w).epsilon(1e-13));
      CHECK(expected.change <= weights * found.change * (1 + 1e-13));  // what is looked at changes by no more
      CHECK(in_place.change == found.change);
    }
}

TEST_CASE("what is measured of a row is by how much it misses the step that its own outputs give") {
  for (const std::string scheme : {"triangle", "guo"})
    for (const auto& [form, sites] : every_pair({0, 1, 2, 3}, sizes)) {
      const bool near = form % 2 != 0, has_constant = form >= 2;
      CAPTURE(scheme, sites, near, has_constant);
      RandomDivision given(scheme, 0, sites);
      const RowLayout& layout = given.layout;
      DivisionRows& r = given.rows;
      r.arguments.near = near;
      r.arguments.known = given.y.row(0);
      r.known_increment = given.old > 0 ? 0 : 1;
      if (!has_constant) r.constant = 0;
      Random random(11);
      for (RowBuffer* row : {&given.y_new, &given.v_new})
        layout.scatter(random_rows(random, 1, sites, 1)[0], row->row(0));
      // Rows of the argument by its formula, and the outputs by the loop that does nothing else.
      RowBuffer E(layout, 1);
      const double *const y = given.y.row(0), *const v = given.v.row(0);
      for (auto at = layout.at(0); at < layout.at(layout.packs()); ++at) {
        given.argument.row(0)[at] = 0;
        for (int p = 0; p < given.parts; ++p)
          given.argument.row(0)[at] += given.increment.look.weights[p] * given.y_new.row(0)[at + p * lanes];
        given.known.row(0)[at] = y[at] - r.known_increment * v[at];
      }
      ArgumentRow apart = r.arguments;
      apart.known = given.known.row(0);
      given.kernel.evaluate_arguments(apart, E.row(0), layout.all());

      const auto measured = [&] {
        const LargestTerms terms = given.kernel.measure_division(r, given.increment);
        return std::pair(max_or_nan(terms.sum) * std::abs(r.of_outputs),
                         max_or_nan(terms.absolute) * std::abs(r.of_outputs));
      };
      const auto [sum, absolute] = measured();
      double largest = 0, size = 0;
      const double* const old_row = given.old_output.row(0);
      for (auto at = layout.at(0); at < layout.at(layout.packs()); ++at) {
        const double next = y[at + lanes] - y[at], last = y[at] - y[at - lanes], w = given.v_new.row(0)[at] - v[at];
        double outputs = E.row(0)[at], sizes = std::abs(outputs);
        if (given.old > 0)
          outputs += old_row[at] + old_row[at - lanes], sizes += std::abs(old_row[at]) + std::abs(old_row[at - lanes]);
        largest = std::max(largest, std::abs(r.constant + r.of_neighbours * (next - last) + r.of_outputs * outputs - w));
        size = std::max(size, std::abs(r.of_neighbours) * (std::abs(next) + std::abs(last)) +
                                  std::abs(r.of_outputs) * sizes + std::abs(w));
      }
      CHECK(sum == Approx(largest).epsilon(1e-13));
      CHECK(absolute == Approx(size).epsilon(1e-13));

      given.v_new.row(0)[layout.at(layout.packs() - 1) + 1] = std::nan("");
      CHECK(std::isnan(measured().second));  // which says that nothing can be said of the first
    }
}

TEST_CASE("a division's loop shows what is not a number") {
  for (const std::string scheme : {"triangle", "guo"})
    for (int v : {0, 3, 7}) {
      CAPTURE(scheme, v);
      RandomDivision given(scheme, 3);
      given.v.row(0)[given.layout.at(v) + 2] = std::nan("");
      CHECK(std::isnan(given.kernel.divide(given.rows, given.increment).largest));
      given.rows.arguments.known = given.y.row(0);
      for (const bool near : {false, true}) {
        given.rows.arguments.near = near;
        CHECK(std::isnan(given.kernel.divide_straight(given.rows, given.increment).largest));
      }
    }
}

TEST_CASE("there are loops of division for the triangle and (5.15), and for their terms alone") {
  const auto divides = [](const std::string& scheme, int old, int parts) {
    return family_of(problem_of("sine-gordon"), scheme, h, k)->row_kernel()->divides(old, parts);
  };
  CHECK(divides("triangle", 2, 2));
  CHECK_FALSE(divides("triangle", 1, 2));
  CHECK_FALSE(divides("triangle", 2, 3));
  CHECK(divides("guo", 0, 1));
  CHECK_FALSE(divides("guo", 1, 1));
  CHECK_FALSE(divides("vu-quoc-li", 0, 1));  // keeps its quotients
  CHECK_FALSE(divides("hexagon", 2, 2));     // of a brick wall
}
