// SPDX-License-Identifier: MIT
#include "schemes/stepping/contraction.hpp"

#include "schemes/stepping/rows/row_equations_step.hpp"
#include "schemes/stepping/rows/row_seed.hpp"
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
  p.mass = mass;
  return evolution_of(p, stencil, Lattice::circle(sites, sites * k), courant * k, options);
}

/// The fixed point of one step by hand, from random rows and a candidate that is off by about `off`.
struct Iterations {
  Evolution made;
  int history;
  SectionRows rows;
  RowEquations equations;
  std::vector<Row> start;

  Iterations(const std::string& theory, const std::string& stencil, double mass, double amplitude, int seed)
      : made(evolution(theory, stencil, mass)),
        history(std::max(made.plan().forward + made.plan().backward, 2)),
        rows(made.system(), std::max(1, made.system().width()), history + 1, history, 0),
        equations(made.system(), made.plan(), rows, history) {
    Random random(static_cast<std::uint64_t>(seed));
    start = random_rows(random, history, sites, amplitude);
    for (std::size_t n = 0; n < start.size(); ++n) {
      rows.set_row(static_cast<std::int64_t>(n), start[n]);
      if (n > 0) rows.find_increment(static_cast<std::int64_t>(n));
    }
    equations.begin(history - 1);
    equations.evaluate_outputs();
    equations.evaluate_known_outputs();
  }
  double largest() const {
    double worst = 0;
    for (double y : start.back()) worst = std::max(worst, std::abs(y));
    return worst;
  }
  /// The largest ratio, over some iterations, of a change of the row to the change before in what is looked at.
  double ratio(double off, int seed) {
    Random random(static_cast<std::uint64_t>(seed));
    Row candidate = start.back();
    for (double& y : candidate) y += random(-off, off);
    equations.candidate().hold_whole();
    rows.layout().scatter(candidate, equations.candidate().row(0));
    double worst = 0, before = 0;
    for (int n = 0; n < 4; ++n) {
      equations.evaluate_unknown_outputs(RowEquations::At::candidate);
      const double change = equations.advance(true).change;
      if (n > 0 && before > 1e-9) worst = std::max(worst, equations.whole_change() / before);
      before = change;
      equations.make_row_the_candidate();
    }
    return worst;
  }
  double bound(const Evolution& of) {
    Contraction contraction(of.system(), of.plan());
    return contraction.next_change(largest(), equations.least_weight(), equations.gain());
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
          REQUIRE(step.equations.gain() > 0);
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

TEST_CASE("without the row equations' own gain the bound holds too, and grows with the field where the theory does") {
  for (const std::string& stencil : implicit_stencils) {
    CAPTURE(stencil);
    Iterations step("phi4", stencil, 1.2, 3.0, 7);
    Contraction contraction(step.made.system(), step.made.plan());
    const double weight = step.equations.least_weight(), gain = step.equations.gain();
    const double crude = contraction.next_change(3.3, weight, 0);
    CHECK(crude >= contraction.next_change(3.3, weight, gain));
    CHECK(step.ratio(0.1, 3) <= crude);
    const double far = contraction.next_change(30, weight, gain);
    CHECK(far > 5 * crude);
    CHECK(contraction.next_change(1, weight, gain) == far);  // fields that were that large may be so again
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
