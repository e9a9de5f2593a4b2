// SPDX-License-Identifier: MIT
#pragma once

namespace delf {

/// An entry of a matrix over the unknowns of a row or slab; entries of one place are to be added.
struct MatrixEntry {
  int row, column;
  double value;
};

}  // namespace delf
