// SPDX-License-Identifier: MIT
#include "schemes/system/equation_terms.hpp"

#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double h = 0.2, k = 0.3;

/// For a linear theory, which has no outputs: the largest difference at any site between the assembled sum over
/// y_n, v_n, v_{n−1}, … and w, and the equation itself, on random rows that solve nothing; relative to the largest |E|.
double assembly_defect(const std::string& theory, const std::string& scheme, const Lattice& lattice, int newest_known) {
  const Evolution evolution = evolution_of(problem_of(theory), scheme, lattice, h);
  const SteppedEquations assembled = assemble(evolution.system(), evolution.plan());
  const int N = lattice.sites();
  Random random(71);
  // Rows n−3 … n+1, with a turn where the theory does not see one.
  Window window{&lattice, 1, lattice.is_circle() && theory == "wave" ? 3.5 : 0, newest_known - 3, {}};
  for (int j = 0; j < 5; ++j) window.rows.push_back(random_row(random, N, 1));
  const int n = newest_known;
  const auto y = [&](int row, int i) { return window(row, i, 0); };
  const auto v = [&](int row, int i) { return y(row, i) - y(row - 1, i); };

  double worst = 0, largest = 0;
  for (int i = 0; i < N; ++i) {
    const EquationTerms* equation = &assembled.bulk[0];
    bool fixed = false;
    for (const SiteEquation& special : assembled.exceptional)
      if (special.site == i) equation = &special.equation, fixed = special.fixed;
    CHECK(fixed == lattice.is_fixed(i));
    if (fixed) continue;
    const int row = n + 1 - equation->shift;
    const double sign = (row + i) % 2 == 0 ? 1 : -1;
    double sum = equation->constant + sign * equation->constant_alternating;
    for (const Term& term : equation->terms) {
      const int s = i + term.shift;
      double source = 0;
      switch (term.source) {
        case Source::difference:
          source = y(n, s) - y(n, i);
          break;
        case Source::value:
          source = y(n, s);
          break;
        case Source::increment:
          source = v(n - term.age, s);
          break;
        case Source::unknown:
          source = v(n + 1, s) - v(n, s);
          break;
        case Source::output:
          FAIL("a linear theory has no outputs");
      }
      sum += (term.coefficient + sign * term.alternating) * source;
    }
    const double E = equation_at(evolution.system(), window, row, i).sum;
    worst = std::max(worst, std::abs(sum - E));
    largest = std::max(largest, std::abs(E));
  }
  return worst / largest;
}

}  // namespace

TEST_CASE("the assembled terms are the equation at every site of any field, solution or not") {
  for (const char* theory : {"wave", "klein-gordon"})
    for (const std::string& scheme : stencil_names())
      for (int newest : {4, 5})  // bricks differ in even and odd rows
        for (int N : {6, 16}) {
          CAPTURE(theory, scheme, N, newest);
          CHECK(assembly_defect(theory, scheme, Lattice::circle(N, N * k), newest) < 1e-14);
        }
}

TEST_CASE("so they are near walls, fixed and natural") {
  for (const char* theory : {"wave", "klein-gordon"})
    for (const std::string& scheme : stencil_names())
      for (Wall left : {Wall::fixed, Wall::natural})
        for (int N : {4, 5, 16}) {
          if (scheme == "hexagon" && left == Wall::natural) continue;  // not stepped
          CAPTURE(theory, scheme, N, left == Wall::natural);
          for (int newest : {4, 5})
            CHECK(assembly_defect(theory, scheme, Lattice::interval(N, (N - 1) * k, left, Wall::fixed), newest) <
                  1e-14);
        }
}

TEST_CASE("sites far from walls share one equation, those near them have their own") {
  const auto exceptional = [](const std::string& scheme, const Lattice& lattice) {
    const Evolution evolution = evolution_of(problem_of("wave"), scheme, lattice, h);
    return assemble(evolution.system(), evolution.plan()).exceptional.size();
  };
  CHECK(exceptional("rectangle", Lattice::circle(50, 10)) == 0);
  CHECK(exceptional("rectangle", Lattice::interval(50, 10)) == 2);
  CHECK(exceptional("nine-tuple", Lattice::interval(50, 10)) == 4);
}
