// SPDX-License-Identifier: MIT
#include "schemes/stepping/contraction.hpp"

#include "schemes/stepping/rows/row_equations.hpp"
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
    for (int back = 1; back <= history; ++back) layout.scatter(start[static_cast<std::size_t>(history - back)], table[y(back)]);
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
    equations.right_side(table, n, 0, {}, 0, layout.packs(), rows[0]);
    equations.solver(0).solve(rows);
    Row change(static_cast<std::size_t>(sites)), increment(change), value(change);
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
            const auto at = static_cast<std::size_t>(made.system().lattice().wrapped(i + part.vertex.space));
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
  double bound(const Evolution& of) {
    Contraction contraction(of.system(), of.plan());
    return contraction.next_change(largest(), 1, 0);
  }
  double bound() { return bound(made); }
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
    CHECK_FALSE(worst <= step.bound(evolution("sine-gordon", stencil, 0.1)));
  }
}

TEST_CASE("the bound is less where the row equations say more, and grows with the field where the theory does") {
  for (const std::string& stencil : implicit_stencils) {
    CAPTURE(stencil);
    Iterations step("phi4", stencil, 1.2, 3.0, 7);
    Contraction contraction(step.made.system(), step.made.plan());
    const double crude = contraction.next_change(3.3, 1, 0), gain = 1e-3;
    CHECK(crude >= contraction.next_change(3.3, 1, gain));
    CHECK(step.ratio(0.1, 3) <= crude);
    const double far = contraction.next_change(30, 1, 0);
    CHECK(far > 5 * crude);
    CHECK(contraction.next_change(1, 1, 0) == far);  // fields that were that large may be so again
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
