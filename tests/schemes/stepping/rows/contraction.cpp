// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/contraction.hpp"

#include <fmt/format.h>

#include <numbers>

#include "lattice/index.hpp"
#include "schemes/stepping/rows/step_tolerance.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

const std::vector<std::string> implicit_stencils{"rectangle", "rectangle-symmetric", "triangle",
                                                 "hexagon",   "six-tuple",           "nine-tuple"};
constexpr double k = 0.25, courant = 0.3;
constexpr int sites = 64;

Evolution evolution(const std::string& theory, const std::string& stencil, double mass, StepOptions options = {}) {
  Problem p = problem_of(theory);
  p.parameters["theory.mass"] = mass;
  return evolution_of(p, stencil, Lattice::circle(sites, sites * k), courant * k, options);
}

/// The fixed point of one step by hand, from random rows: A₊ w = −(all but the source terms of row n + 1) − theirs.
struct Iterations {
  Evolution made;
  int history, seed;
  RowLayout layout;
  RowTable table;
  RowEquations equations;
  std::vector<Row> start;
  std::int64_t n;

  Iterations(const std::string& theory, const std::string& stencil, double mass, double amplitude, int random_seed)
      : made(evolution(theory, stencil, mass)),
        history(std::max(made.plan().forward + made.plan().backward, 2)),
        seed(random_seed),
        layout(made.system().lattice(), std::max(1, made.system().width()), stencil == "hexagon" ? 2 : 1),
        equations(made.system(), made.plan(), layout, table, history, 1),
        n(history - 1) {
    Random random(static_cast<std::uint64_t>(seed));
    start = random_rows(random, history, sites, amplitude);
    for (int back = 1; back <= history; ++back) layout.scatter(start[history - back], table[y(back)]);
    for (int back = 1; back < history; ++back)
      for (std::size_t i = 0; i < layout.doubles(); ++i)
        table[equations.v().row(back)][i] = table[y(back)][i] - table[y(back + 1)][i];
    for (std::size_t s = 0; s < equations.sources().size(); ++s) {
      const SourceRow& source = equations.sources()[s];
      for (int back = 1; back <= source.newest - source.oldest; ++back) evaluate(source, back);
    }
  }
  int y(int back) const { return equations.y().row(back); }
  void evaluate(const SourceRow& source, int back) {
    double* const out[]{table[source.ring.row(back)]};
    equations.evaluate(table, n, source, back, 0, layout.packs(), out);
    layout.fill_halo(out[0]);
  }
  double largest() const {
    double worst = 0;
    for (double x : start.back()) worst = std::max(worst, std::abs(x));
    return worst;
  }
  /// The source terms of row n + 1, from a candidate for it.
  void evaluate_unknown(const Row& candidate) {
    layout.scatter(candidate, table[y(0)]);
    for (std::size_t i = 0; i < layout.doubles(); ++i) table[equations.v().row(0)][i] = table[y(0)][i] - table[y(1)][i];
    for (const SourceRow& source : equations.sources()) evaluate(source, 0);
  }
  /// What the next iteration makes of it.
  Row advance() {
    RowBuffer w(layout, 1);
    double* const rows[]{w.row(0)};
    equations.right_side(table, n, 0, Solving::step, 0, layout.packs(), rows[0]);
    equations.solver(0).solve(rows);
    Row change(delf::at(sites)), increment(change), value(change);
    layout.gather(w.row(0), change);
    layout.gather(table[equations.v().row(1)], increment);
    layout.gather(table[y(1)], value);
    for (std::size_t i = 0; i < value.size(); ++i) value[i] += increment[i] + change[i];
    return value;
  }
  /// The largest |m| of the quadrature values at row n + 1 that belong to a change of the field there.
  double quadrature_change(const Row& from, const Row& to) const {
    double worst = 0;
    const StencilFamily& family = *made.system().families()[0];
    const int latest = family.sources()->groups[0].latest_time();
    for (const SourceTerms::Group& group : family.sources()->groups)
      for (int i = 0; i < sites; ++i) {
        double m = 0, weight = 0;
        for (const SourceTerms::Part& part : group.inputs[0])
          if (part.vertex.time == latest) {
            const std::size_t at = made.system().lattice().wrapped(i + part.vertex.space);
            m += part.weight * (to[at] - from[at]), weight += part.weight;
          }
        if (weight != 0) worst = std::max(worst, std::abs(m) / weight);
      }
    return worst;
  }
  /// The largest ratio, over some iterations, of a change of the row to the change before of the quadrature values.
  double ratio(double off, int of_seed) {
    Random random(static_cast<std::uint64_t>(of_seed));
    Row candidate = start.back();
    for (double& x : candidate) x += random(-off, off);
    double worst = 0, before = 0;
    for (int round = 0; round < 4; ++round) {
      evaluate_unknown(candidate);
      const Row next = advance();
      if (round > 0 && before > 1e-9) worst = std::max(worst, distance(next, candidate) / before);
      before = quadrature_change(candidate, next);
      candidate = next;
    }
    return worst;
  }
  /// What is said of fields of a size, and of others after them.
  std::vector<double> bounds(const std::vector<double>& fields) {
    StepTolerance tolerance(made.system(), equations, layout, table, {});
    std::vector<double> all;
    for (const double size : fields) all.push_back(tolerance.contraction().next_change(size, n));
    return all;
  }
  double bound() { return bounds({largest()}).front(); }
};

double span(const Row& row) {
  const auto [least, most] = std::ranges::minmax(row);
  return most - least;
}

}  // namespace

TEST_CASE("the next change of a row is below what Contraction says, on random sections") {
  for (const std::string theory : {"sine-gordon", "phi4"})
    for (const std::string& stencil : implicit_stencils)
      for (double mass : {0.4, 1.2, 3.0})
        for (double amplitude : {0.5, 3.0, 6.0}) {
          CAPTURE(theory, stencil, mass, amplitude);
          Iterations step(theory, stencil, mass, amplitude, 7);
          const double bound = step.bound();
          CHECK(bound > 0);
          CHECK(std::isfinite(bound));
          double worst = 0;
          for (int seed = 1; seed <= 5; ++seed)
            for (double off : {0.3, 1e-3, 1e-6}) worst = std::max(worst, step.ratio(off, seed));
          CHECK(worst > 0);
          CHECK(worst <= bound);
        }
}

TEST_CASE(
    "the bound is no idle one: uniform candidates come within a factor of some ten, and another mass exceeds it") {
  for (const std::string& stencil : implicit_stencils) {
    CAPTURE(stencil);
    Iterations step("sine-gordon", stencil, 1.2, 1e-3, 7);
    double worst = 0;
    for (int seed = 1; seed <= 5; ++seed) worst = std::max(worst, step.ratio(1e-3, seed));
    CHECK(worst > step.bound() / 40);
    CHECK_FALSE(worst <= Iterations("sine-gordon", stencil, 0.1, 1e-3, 7).bound());
  }
}

TEST_CASE("the bound grows with the field where the theory does") {
  for (const std::string& stencil : implicit_stencils) {
    CAPTURE(stencil);
    Iterations step("phi4", stencil, 1.2, 3.0, 7);
    const std::vector<double> bounds = step.bounds({3.3, 30, 1});
    CHECK(step.ratio(0.1, 3) <= bounds[0]);
    CHECK(bounds[1] > 5 * bounds[0]);
    CHECK(bounds[2] == bounds[1]);  // fields that were that large may be so again
  }
}

namespace {

/// A wave of amplitude A in a potential ¼(φ² − A²)²/A² on a circle whose sites are k apart, so many steps of h = k/4.
struct Scaled {
  double A = 1, k = 0.2, density = 1;  ///< ℓ is multiplied by `density`
};
struct Stepped {
  int iterations = 0, continued = 0;
  Row row;
};
Stepped stepped(const Scaled& s, const std::string& stencil) {
  Problem p = problem_of("text");
  // Lengths and times in units of 5k
  p.parameters["theory.density"] = fmt::format("{0:e}*({1:e}*(phi_t^2 - phi_x^2)/2 - (phi^2 - {2:e})^2/(4*{2:e}))",
                                               s.density, 25 * s.k * s.k, s.A * s.A);
  constexpr int N = 64;
  Evolution evolution = evolution_of(p, stencil, Lattice::circle(N, N * s.k), s.k / 4);
  Stepper& stepper = evolution.stepper();
  std::vector<Row> start;
  for (int j = 0; j < stepper.starting_rows(); ++j) {
    start.emplace_back();
    for (int i = 0; i < N; ++i)
      start.back().push_back(s.A * (0.8 + 0.3 * std::sin(2 * std::numbers::pi * (i - 0.2 * j) / N)));
  }
  stepper.start(start);
  Stepped result;
  for (int n = 0; n < 40; ++n) {
    stepper.step();
    result.iterations += stepper.iterations();
    result.continued += stepper.continued() != Continued::no;
  }
  result.row = stepper.row(0);
  for (double& y : result.row) y /= s.A;
  return result;
}

}  // namespace

TEST_CASE("steps are the same in any units of the field, of length and of the action, and none is called stiff") {
  for (const std::string& stencil : implicit_stencils) {
    const Stepped usual = stepped({}, stencil);
    CHECK(usual.iterations > 0);
    for (const Scaled& units : {Scaled{1e-6}, Scaled{1e6}, Scaled{1, 2e-10}, Scaled{1, 2e8}, Scaled{1, 0.2, 1e-30},
                                Scaled{1e6, 2e-10, 1e9}}) {
      CAPTURE(stencil, units.A, units.k, units.density);
      const Stepped other = stepped(units, stencil);
      CHECK(other.continued == 0);
      CHECK(std::abs(other.iterations - usual.iterations) <= 4);
      CHECK(distance(other.row, usual.row) < 1e-11);
    }
  }
}

TEST_CASE("a planet a thousand units away is iterated, though the potential has no bound among smaller fields") {
  Problem p = problem_of("text");
  p.parameters["theory.density"] = std::string("0.5*(u_t^2 + v_t^2) + 1e9/sqrt(u^2 + v^2)");
  p.parameters["theory.fields"] = std::string("u, v");
  const double h = 1e-3;
  Evolution evolution = evolution_of(p, "midpoint", Lattice::point(), h);
  Stepper& stepper = evolution.stepper();
  // r = 1000, ω = 1: the discrete circle has the angle a step that tan(½ωh) = ½h would have, to h³
  stepper.start({{1000, 0}, {1000 * std::cos(h), 1000 * std::sin(h)}});
  for (int n = 0; n < 200; ++n) {
    stepper.step();
    CHECK(stepper.continued() == Continued::no);
    CHECK(stepper.iterations() <= 5);
  }
  CHECK(std::abs(std::hypot(stepper.row(0)[0], stepper.row(0)[1]) - 1000) < 1e-3);
  CHECK(std::abs(std::atan2(stepper.row(0)[1], stepper.row(0)[0]) - 201 * h) < 1e-5);
}

TEST_CASE("where the iteration does not contract and there is one root, Newton's method finds it at once") {
  for (const std::string& stencil : {"rectangle", "rectangle-symmetric"}) {
    Evolution evolution = delf::testing::evolution_of(
        [] {
          Problem p = problem_of("sine-gordon");
          p.parameters["theory.mass"] = 1.8 / 1.25;  // mh = 1.8
          return p;
        }(),
        stencil, Lattice::circle(sites, sites * k), 1.25);
    CAPTURE(stencil);
    Random random(3);
    Stepper& stepper = evolution.stepper();
    stepper.start(random_rows(random, 2, sites, 1));
    int slow = 0, most = 0;
    for (int n = 0; n < 20; ++n) {
      stepper.step();
      CHECK(stepper.residual() < 1e-13);
      CHECK(stepper.continued() != Continued::stiff);
      slow += stepper.continued() == Continued::slow;
      if (stepper.continued() == Continued::slow) most = std::max(most, stepper.iterations());
    }
    CHECK(slow > 0);
    CHECK(most < 50);  // followed from a small time step it takes some hundred
  }
}

TEST_CASE("a step that was accepted early is as near the root as the tolerance says") {
  for (const std::string theory : {"sine-gordon", "phi4"})
    for (const std::string& stencil : implicit_stencils)
      for (double amplitude : {0.5, 3.0}) {
        StepOptions tight;
        tight.tolerance = 1e-15;
        Evolution exact = evolution(theory, stencil, 1.2, tight);
        Random random(11);
        const auto start = random_rows(random, exact.stepper().starting_rows(), sites, amplitude);
        exact.stepper().start(start);
        exact.stepper().step();
        const Row root = exact.stepper().row(0);
        bool once = false, often = false;
        for (double tolerance : {1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10}) {
          StepOptions options;
          options.tolerance = tolerance;
          Evolution loose = evolution(theory, stencil, 1.2, options);
          loose.stepper().start(start);
          loose.stepper().step();
          const int iterations = loose.stepper().iterations();
          CAPTURE(theory, stencil, amplitude, tolerance, iterations);
          const double error = distance(loose.stepper().row(0), root);
          CHECK(error <= tolerance * span(start.back()) + 1e-13);
          once = once || (iterations == 1 && error > 1e-9);
          often = often || iterations > 1;
        }
        CAPTURE(theory, stencil, amplitude);
        CHECK(once);  // some steps stopped at once, and were not the root
        CHECK(often);
      }
}

TEST_CASE("the comparison with a root can fail: of another amplitude's tolerance") {
  StepOptions loose;
  loose.tolerance = 1e-2;
  Evolution early = evolution("phi4", "rectangle-symmetric", 1.2, loose),
            exact = evolution("phi4", "rectangle-symmetric", 1.2);
  Random random(11);
  const auto start = random_rows(random, 2, sites, 3);
  for (Evolution* e : {&early, &exact}) e->stepper().start(start), e->stepper().step();
  CHECK(distance(early.stepper().row(0), exact.stepper().row(0)) > 1e-6 * span(start.back()));
}
