// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "lattice/lattice.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/families/r_adaptive.hpp"
#include "tests/verification/r_adaptive_rows.hpp"

using namespace delf;

namespace {

namespace reference = r_adaptive_rows;

std::vector<double> row(const auto& phi, const auto& mesh) {
  std::vector<double> values;
  for (std::size_t i = 0; i < std::size(phi); ++i) values.insert(values.end(), {phi[i], mesh[i], 0.0});
  return values;
}

/// One soliton, N = 15 nodes between the walls, stepped to row 10: the largest differences in φ and X.
std::pair<double, double> distance_to_row_10(double alpha) {
  Evolution evolution(Lattice::interval(17, 25),
                      {std::make_shared<LagrangianFamily<MovingRectangle>>(MovingRectangle{}),
                       std::make_shared<LagrangianFamily<ArclengthConstraint>>(ArclengthConstraint{alpha})},
                      reference::time_step, {}, {{"phi"}, {"X"}, {"lambda", Role::multiplier, {}}});
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
