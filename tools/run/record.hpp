// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace delf {

/// What is told of a recorded row, apart from its values.
struct Record {
  std::int64_t row = 0;
  double time = 0;
  double energy = 0, energy_error = 0;  ///< of this row and the one before it (rows 0 and 1: both); relative to row 0
  double momentum = 0, charge = 0;
  int iterations = 0;  ///< of the step that gave this row; the starting rows have none
  double residual = 0;
  std::vector<double> further;  ///< the constraint, if the scheme has any, and the conserved sums
};

/// A recorded row, by the roles of its components, each site by site.
struct RecordedRow {
  std::span<const double> field, inner, multiplier;
};

}  // namespace delf
