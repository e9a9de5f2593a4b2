// SPDX-License-Identifier: MIT
#include "schemes/families/r_adaptive.hpp"

#include <algorithm>
#include <cmath>

#include "lattice/lattice.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/stepping/evolution.hpp"
#include "tests/catch.hpp"
#include "tests/verification/r_adaptive_rows.hpp"

using namespace delf;

namespace {

namespace reference = r_adaptive_rows;

std::vector<double> row(const auto& phi, const auto& mesh) {
  std::vector<double> values;
  for (std::size_t i = 0; i < std::size(phi); ++i) values.insert(values.end(), {phi[i], mesh[i], 0.0});
  return values;
}

/// One soliton, N = 15 nodes between the walls.
Evolution soliton(double alpha, double tolerance = StepOptions{}.tolerance) {
  return {Lattice::interval(17, 25),
          {std::make_shared<LagrangianFamily<MovingRectangle>>(MovingRectangle{}),
           std::make_shared<LagrangianFamily<ArclengthConstraint>>(ArclengthConstraint{alpha})},
          reference::time_step,
          {.tolerance = tolerance},
          {{"phi"}, {"X"}, {"lambda", Role::multiplier, {}}}};
}

/// Stepped to row 10: the largest differences in φ and X.
std::pair<double, double> distance_to_row_10(double alpha) {
  Evolution evolution = soliton(alpha);
  Stepper& stepper = evolution.stepper();
  stepper.start({row(reference::y0, reference::X0), row(reference::y1, reference::X1)});
  while (stepper.newest() < 10) {
    stepper.step();
    CHECK(stepper.residual() < 1e-12);
  }
  const auto newest = stepper.row(0);
  std::pair<double, double> worst{0, 0};
  for (std::size_t i = 0; i < std::size(reference::y10); ++i) {
    worst.first = std::max(worst.first, std::abs(newest[3 * i] - reference::y10[i]));
    worst.second = std::max(worst.second, std::abs(newest[3 * i + 1] - reference::X10[i]));
  }
  return worst;
}

}  // namespace

TEST_CASE("the trapezoidal r-adaptive scheme gives row 10 of an independent program to 1e-11") {
  const auto [phi, mesh] = distance_to_row_10(reference::alpha);
  CAPTURE(phi, mesh);
  CHECK(phi < 1e-11);
  CHECK(mesh < 1e-11);
}

TEST_CASE("the comparison can fail: another alpha moves the mesh elsewhere") {
  CHECK(distance_to_row_10(1.01 * reference::alpha).second > 1e-4);
}

// The equations are a block of 45, whose Jacobian is kept from step to step. Every step is solved once more from the same
// two rows, as far as rounding allows.
TEST_CASE("a kept Jacobian leaves less than the tolerance in every step, for 400 steps") {
  const double tolerance = GENERATE(1e-6, 1e-9, 1e-12);
  Evolution kept = soliton(reference::alpha, tolerance), converged = soliton(reference::alpha, 0);
  std::vector<std::vector<double>> rows{row(reference::y0, reference::X0), row(reference::y1, reference::X1)};
  kept.stepper().start(rows);
  double worst = 0;
  int iterations = 0;
  for (int n = 0; n < 400; ++n) {
    kept.stepper().step(), iterations += kept.stepper().iterations();
    converged.stepper().start(rows), converged.stepper().step();
    const auto found = kept.stepper().row(0), root = converged.stepper().row(0);
    for (std::size_t i = 0; i < found.size(); ++i)
      if (i % 3 != 2) worst = std::max(worst, std::abs(found[i] - root[i]));
    rows = {rows[1], found};
  }
  CAPTURE(tolerance, worst, iterations);
  CHECK(worst <= tolerance * 25);  // of the largest value, a position
  // The comparison sees what is left: where the tolerance is looser, more than the tightest would allow.
  if (tolerance > 1e-12) CHECK(worst > 1e-12 * 25);
  CHECK(iterations < 4 * 400);
}
