// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <vector>

#include "schemes/complex/cell_space.hpp"

namespace delf::testing {

/// The sites of the mesh at some times, row after row, as one complex. Stencils of motion join rows; those of sites and cells
/// lie in a row, and have the mean of the steps below and above it,
///
///     S = Σ_j Σ_i A_i h_j T((y_i^{j+1} − y_i^j)/h_j) + Σ_j ½(h_{j−1} + h_j) V(y^j),
///
/// where the first and the last row have half a step. Rows 0 and 1 are data, and equations hold from row 1 to the last but
/// one. With a constraint G(y^{j+1}) = 0 and the equations of y^j determine y^{j+1} and λ^j together: SHAKE on a mesh.
class SpaceRows {
 public:
  SpaceRows(const CellSpace&, std::span<const double> times);
  const ComplexSystem& system() const { return system_; }

 private:
  ComplexSystem system_;
};

}  // namespace delf::testing
