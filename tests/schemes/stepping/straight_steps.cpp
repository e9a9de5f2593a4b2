// SPDX-License-Identifier: MIT
#include <numbers>

#include "jets/tables/triangle_jet.hpp"
#include "schemes/stepping/rows/row_equations_step.hpp"
#include "schemes/scheme.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// Steps of one loop through rows that stay in the cache: they may go along straight lines between the seed's looks.
constexpr int N = 1003;

Problem problem(const std::string& scheme) {
  Problem p = problem_of("sine-gordon");
  p.lattice = Lattice::circle(N, 40);
  (scheme == "guo" ? p.method : p.stencil) = scheme;
  p.time_step = p.lattice.space_step() / 64;
  return p;
}
/// Pendulums about a height, a little out of phase with their neighbours.
std::vector<Row> begin(const Problem& p, double height) {
  std::vector<Row> rows(2);
  for (int i = 0; i < N; ++i) {
    const double wave = std::sin(2 * std::numbers::pi * i / N);
    rows[0].push_back(height + 0.2 * wave);
    rows[1].push_back(rows[0].back() + 0.3 * p.time_step * wave);
  }
  return rows;
}
double largest_difference(const Row& a, const Row& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

}  // namespace

TEST_CASE("a step along straight lines is that from arguments extrapolated with order 1") {
  for (const std::string scheme : {"triangle", "guo"}) {
    CAPTURE(scheme);
    const Problem p = problem(scheme);
    const Evolution evolution = evolution_of(p, scheme, p.lattice, p.time_step);
    SectionRows rows(evolution.system(), std::max(1, evolution.system().width()), 3, 2, 0);
    RowEquations equations(evolution.system(), evolution.plan(), rows, 2, Mixture::of(evolution.system()), 7);
    REQUIRE(equations.goes_straight());
    CHECK_FALSE(equations.can_go_in_place());  // rows before the newest are there for arguments
    const std::vector<Row> start = begin(p, 1);
    for (int r = 0; r < 2; ++r) rows.set_row(r, start[static_cast<std::size_t>(r)]);
    rows.find_increment(1);
    equations.begin(1);
    equations.evaluate_outputs();
    const RowChange straight = equations.advance_straight(10);
    const Row found = rows.row(2);
    const RowChange extrapolated = equations.advance_extrapolated(1, 10);
    CHECK(largest_difference(found, rows.row(2)) < 1e-15);
    CHECK(largest_difference(found, start[1]) > 1e-4);
    CHECK(straight.largest == Approx(extrapolated.largest).epsilon(1e-15));
    CHECK(straight.change >= extrapolated.change * (1 - 1e-9));
    CHECK(straight.change < 2 * extrapolated.change);
  }
}

TEST_CASE("steps along straight lines solve the equations to the tolerance, through the seed's looks, whoever looks") {
  for (const std::string scheme : {"triangle", "guo"}) {
    CAPTURE(scheme);
    Problem p = problem(scheme);
    p.tolerance = 6e-8;
    Problem to_rounding = p;
    to_rounding.tolerance = 1e-15;
    Simulation simulation(p), again(p), exact(to_rounding);
    const std::vector<Row> start = begin(p, std::numbers::pi - 0.3);
    for (Simulation* s : {&simulation, &again, &exact}) s->start(start);
    for (int n = 0; n < 700; ++n) {
      simulation.step(true), again.step(n % 3 == 0), exact.step(true);
      REQUIRE(simulation.iterations() == 1);
    }
    const auto row = [](const Simulation& s) { return s.evolution().stepper().row(0); };
    const bool same = row(simulation) == row(again);
    CHECK(same);
    const double difference = largest_difference(row(simulation), row(exact));
    CHECK(difference < 6e-8);
    CHECK(difference > 1e-12);  // these steps do leave something
  }
}

namespace {

/// ℓ = ½φ_t² − ½φ_x² + cos φ − 1 + F(t) φ, with a blow F that lasts for some steps.
struct Struck {
  static constexpr bool placed = true;
  double when, duration, force;
  auto operator()(const auto& j) const {
    const auto s = (j.t - when) * (1 / duration);
    return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) + cosm1(j.phi) + force * exp(-(s * s)) * j.phi;
  }
};

}  // namespace

TEST_CASE("where a straight line is not enough any more, the step goes on from arguments") {
  const Problem p = problem("triangle");
  const double h = p.time_step;
  const Scheme scheme{triangle, Struck{60.3 * h, 2 * h, 4e5}};
  Evolution evolution = scheme.on(p.lattice, h, {.tolerance = 6e-8}), exact = scheme.on(p.lattice, h);
  for (Evolution* e : {&evolution, &exact}) e->stepper().start(begin(p, 1));
  int of_more = 0;
  for (int n = 1; n < 300; ++n) {
    for (Evolution* e : {&evolution, &exact}) e->stepper().step();
    CAPTURE(n);
    if (n < 50) REQUIRE(evolution.stepper().iterations() == 1);
    of_more += evolution.stepper().iterations() > 1;
    const Row row = evolution.stepper().row(0);
    REQUIRE(largest_difference(row, exact.stepper().row(0)) < 6e-8 * std::abs(row[0]));
  }
  CHECK(of_more > 0);
  CHECK(evolution.stepper().row(0)[0] > 100);
}
