// SPDX-License-Identifier: MIT
#include "schemes/stepping/step_density.hpp"

#include <cmath>

#include "lattice/error.hpp"
#include "schemes/stepping/saved_state.hpp"

namespace delf {

double StepDensity::step() const {
  const double h = longest_ / density_;
  if (!(density_ > 0) || !std::isnormal(h))
    throw NotFinite("the density of rows in time is not positive; use a shorter time step or a weaker step control");
  return h;
}

double StepDensity::first(const RowDensity& row) {
  density_ = row.density + 0.5 * longest_ * row.slope;
  return step();
}

double StepDensity::next(const RowDensity& row) {
  density_ += longest_ * row.slope;
  return step();
}

double StepDensity::go_on_from(double density) {
  density_ = density;
  return step();
}

void StepDensity::visit(SavedState& state) { state("density of rows", density_); }

}  // namespace delf
