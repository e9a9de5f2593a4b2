// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "tools/files/row_names.hpp"

namespace delf {

/// The monitors of a recorded row.
struct Record {
  std::int64_t row = 0;
  double time = 0;
  double energy = 0, energy_error = 0;  ///< of this row and the one before it (rows 0 and 1: both); relative to row 0
  double momentum = 0, charge = 0;
  int iterations = 0;  ///< of the step that gave this row; the starting rows have none
  double residual = 0;
  std::vector<double> further;  ///< the constraint if there is one, the method's monitors, the conserved sums
};

/// A recorded row: the components of each role, site by site.
using RecordedRow = ByRole<std::vector<double>>;

/// The data sets that the method declares beside the components, each site by site: RowNames::datasets.
using RecordedDatasets = std::vector<std::vector<double>>;

}  // namespace delf
