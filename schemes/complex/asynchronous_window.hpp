// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "schemes/complex/cell_space.hpp"
#include "schemes/stepping/asynchronous_stepper.hpp"

namespace delf {

/// The updates of cells with steps of their own, and the values of the sites at theirs, as a complex. Each site's first two
/// times are data.
struct AsynchronousWindow {
  /// The updates that the stepper has kept.
  AsynchronousWindow(const CellSpace&, const AsynchronousStepper&);

  ComplexSystem system;
  std::vector<double> values;
};

}  // namespace delf
