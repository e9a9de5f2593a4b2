// SPDX-License-Identifier: MIT
#include <numbers>

#include "schemes/stepping/rows/row_equations_step.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// Long enough to go strip by strip, and not a multiple of the lanes.
constexpr int N = 33002;

Problem problem(const std::string& scheme) {
  Problem p = problem_of("sine-gordon");
  p.lattice = Lattice::circle(N, 40);
  const bool compared = scheme == "vu-quoc-li" || scheme == "guo";
  (compared ? p.method : p.stencil) = scheme;
  p.time_step = p.lattice.space_step() / 8;
  p.tolerance = 6e-8;
  return p;
}
/// A pendulum at every site, a little out of phase with its neighbours.
std::vector<Row> begin(const Problem& p, double height, double speed) {
  std::vector<Row> rows(2);
  for (int i = 0; i < N; ++i) {
    const double wave = std::sin(2 * std::numbers::pi * i / N);
    rows[0].push_back(height + 0.2 * wave);
    rows[1].push_back(rows[0].back() + p.time_step * (speed + 0.3 * wave));
  }
  return rows;
}
Row row_of(const Simulation& simulation, int back = 0) { return simulation.evolution().stepper().row(back); }
bool holds_two_rows(const Simulation& simulation) {
  try {
    row_of(simulation, 1);
    return true;
  } catch (const std::logic_error&) {
    return false;
  }
}
/// Not to be printed.
bool same(const Row& a, const Row& b) { return a == b; }

/// Two runs, of which one looks at every row; how often the other wrote over the row before, and what steps took.
struct TwoRuns {
  Simulation looked_at, other;
  int in_place = 0, steps_of_one = 0, steps_of_more = 0;

  TwoRuns(const Problem& p, double height, double speed = 0) : looked_at(p), other(p) {
    for (Simulation* s : {&looked_at, &other}) s->start(begin(p, height, speed));
  }
  /// `at_more`: the other looks where the step takes more than one iteration, too.
  void step(bool look, bool at_more = false) {
    looked_at.step(true);
    other.step(look || (at_more && looked_at.iterations() > 1));
    in_place += holds_two_rows(other) ? 0 : 1;
    (looked_at.iterations() == 1 ? steps_of_one : steps_of_more) += 1;
    CHECK(other.iterations() == looked_at.iterations());
  }
};

/// Equations of a step from two rows.
struct LongRows {
  Problem p;
  Evolution evolution;
  SectionRows rows;
  RowEquations equations;

  explicit LongRows(const std::string& scheme)
      : p(problem(scheme)),
        evolution(evolution_of(p, scheme, p.lattice, p.time_step)),
        rows(evolution.system(), std::max(1, evolution.system().width()), 3, 2, 0),
        equations(evolution.system(), evolution.plan(), rows, 2) {}
  void begin_with(const std::vector<Row>& start) {
    for (int n = 0; n < 2; ++n) rows.set_row(n, start[static_cast<std::size_t>(n)]);
    rows.find_increment(1);
    equations.begin(1);
    equations.evaluate_outputs();
  }
};

}  // namespace

TEST_CASE("streams through long rows write over the old ones without a bit's difference, unless someone looks") {
  for (const std::string scheme : {"rectangle", "rectangle-symmetric", "triangle", "hexagon", "vu-quoc-li", "guo"}) {
    CAPTURE(scheme);
    TwoRuns runs(problem(scheme), 1);
    for (int n = 0; n < 40; ++n) runs.step(n % 13 == 12);
    CHECK(runs.steps_of_more < 6);  // the first ones
    CHECK(same(row_of(runs.other), row_of(runs.looked_at)));
    for (int n = 0; n < 3; ++n) runs.step(true);
    CHECK(same(row_of(runs.other), row_of(runs.looked_at)));
    CHECK(same(row_of(runs.other, 1), row_of(runs.looked_at, 1)));
    CHECK(runs.other.residual() == runs.looked_at.residual());
    CHECK(runs.other.residual() < 1e-6);
    CHECK(runs.other.monitors().energy == runs.looked_at.monitors().energy);
    CHECK(runs.in_place > 20);
  }
}

TEST_CASE("seeds are chosen at the same steps, whether rows are written over or not") {
  TwoRuns runs(problem("rectangle"), 1);
  for (int n = 0; n < 540; ++n) runs.step(n == 400);
  CHECK(runs.in_place > 480);
  CHECK(runs.in_place < 535);
  CHECK(same(row_of(runs.other), row_of(runs.looked_at)));
}

namespace {

/// Seeds that are straight lines, and steps so long that these suffice only where the field bends little.
Problem with_long_steps(const std::string& scheme) {
  Problem p = problem(scheme);
  p.lattice = Lattice::circle(N, 0.1 * N);
  p.time_step = 0.02;
  p.mass = 1;
  p.seed_order = 2;
  p.tolerance = scheme == "hexagon" ? 2.2e-7 : scheme == "guo" ? 3.4e-7 : 1.6e-7;
  return p;
}

}  // namespace

TEST_CASE("a step in place that would take a second iteration is taken again from rows that were kept") {
  for (const std::string scheme : {"rectangle", "triangle", "hexagon", "vu-quoc-li", "guo"}) {
    CAPTURE(scheme);
    TwoRuns runs(with_long_steps(scheme), 0.3);
    for (int n = 0; n < 400; ++n) runs.step(n % 90 == 89);
    CHECK(runs.in_place > 100);
    CHECK(runs.steps_of_one > 100);
    CHECK(runs.steps_of_more > 100);
    CHECK(same(row_of(runs.other), row_of(runs.looked_at)));
  }
}

TEST_CASE("so is a step beside the row before, if its second iteration reads a row that was written over") {
  for (const std::string scheme : {"triangle", "guo"}) {
    CAPTURE(scheme);
    TwoRuns runs(with_long_steps(scheme), 0.3);
    for (int n = 0; n < 400; ++n) runs.step(false, true);
    CHECK(runs.in_place > 100);
    CHECK(runs.steps_of_more > 100);
    CHECK(same(row_of(runs.other), row_of(runs.looked_at)));
  }
}

TEST_CASE("a stream sees every change that the whole row shows, at the ends of its strips too") {
  for (const std::string scheme : {"rectangle", "rectangle-symmetric", "hexagon"}) {
    CAPTURE(scheme);
    LongRows long_rows(scheme);
    auto& [p, evolution, rows, equations] = long_rows;
    REQUIRE(equations.is_streamed());
    const RowLayout& layout = rows.layout();
    const std::vector<Row> start = begin(p, 1, 0);
    long_rows.begin_with(start);
    equations.candidate().hold_whole();
    Row straight;
    for (std::size_t i = 0; i < start[0].size(); ++i) straight.push_back(2 * start[1][i] - start[0][i]);
    std::vector<int> packs{0, 1, 2, 2000, layout.packs() - 3, layout.packs() - 2, layout.packs() - 1};
    for (int end : {1024, 2048})  // strips are done some packs before their ends
      for (int pack = end - 190; pack < end + 3; ++pack) packs.push_back(pack);
    for (int pack : packs) {
      Row candidate = straight;
      const int site = layout.start(lanes - 1) + pack;
      candidate[static_cast<std::size_t>(site)] += 1e-3;
      CAPTURE(pack);
      const auto put = [&] { layout.scatter(candidate, equations.candidate().row(0)); };
      put();
      equations.evaluate_unknown_outputs(RowEquations::At::candidate);
      const RowChange whole = equations.advance(true);
      put();
      const RowChange streamed = equations.advance_streamed({});
      CHECK(whole.change > 1e-4);
      CHECK(streamed.change == Approx(whole.change).epsilon(1e-9));
      CHECK(streamed.largest == Approx(whole.largest).epsilon(1e-14));
    }
  }
}

TEST_CASE("a stream along straight lines makes the row of the candidate y + v, and bounds what is looked at of it") {
  for (const std::string scheme : {"rectangle", "rectangle-symmetric", "hexagon"}) {
    CAPTURE(scheme);
    LongRows long_rows(scheme);
    auto& [p, evolution, rows, equations] = long_rows;
    const RowLayout& layout = rows.layout();
    REQUIRE(equations.is_streamed());
    REQUIRE(equations.goes_straight());
    // A spike in v, so that w has one: where strips end too, and at the seam.
    for (int pack : {0, 500, 1023, 1024, 2000, layout.packs() - 1}) {
      CAPTURE(pack);
      std::vector<Row> start = begin(p, 1, 0);
      start[1][static_cast<std::size_t>(layout.start(lanes - 1) + pack)] += 1e-3;
      long_rows.begin_with(start);
      equations.candidate().hold_whole();
      Row straight;
      for (std::size_t i = 0; i < start[0].size(); ++i) straight.push_back(start[1][i] + (start[1][i] - start[0][i]));
      layout.scatter(straight, equations.candidate().row(0));
      const RowChange exact = equations.advance_streamed({});
      const Row expected = rows.row(2);
      const RowChange change = equations.advance_straight(10);
      const Row found = rows.row(2);
      CHECK(same(found, expected));
      double w = 0;
      for (std::size_t i = 0; i < found.size(); ++i) w = std::max(w, std::abs(found[i] - straight[i]));
      CHECK(w > 1e-5);
      CHECK(change.change == Approx(equations.most_weight() * w).epsilon(1e-9));
      CHECK(change.change >= exact.change * (1 - 1e-12));
      CHECK(change.largest == exact.largest);
    }
  }
}
