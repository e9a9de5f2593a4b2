// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "schemes/complex/cell_space.hpp"

namespace delf::testing {

/// The potential of a mesh on rows of a complex, whose stencils have the measure of their row,
///
///     Σ_i A_i V(φ_i) + Σ_cells [V(φ, ∇φ) − V(φ, 0)],
///
/// and with constraints A_i Σ_m λ_im G_m(φ_i) besides. Then every value is a site of the
/// complex of its own, since equations of one point are not matched with its own unknowns. A row has the sites of the fields,
/// point by point, and behind them those of the multipliers, where there are any.
class PotentialRows {
 public:
  PotentialRows(const CellSpace&, ComplexSystem&);
  /// A complex for it: of as many components as its sites have.
  static ComplexSystem make_complex(const CellSpace& space) {
    return ComplexSystem(space.constraint ? 1 : space.fields());
  }

  /// Sites and stencils of one more row; points of the fixed boundary are data.
  void add(double t, double measure);
  int per_point() const { return per_point_; }  ///< sites that hold the fields of a point
  int per_row() const { return per_row_; }
  /// The point that a site of a row belongs to.
  int point_of(int site) const;
  /// The sites that hold the fields of some points in a row, appended.
  void append_sites(int row, std::span<const std::int32_t> points, std::vector<int>& sites) const;

 private:
  const CellSpace& space_;
  ComplexSystem& system_;
  int per_point_, per_row_, rows_ = 0;
  int site_ = 0, constraint_ = 0;     ///< families
  std::vector<int> gradient_;         ///< the family of each cell
  std::vector<int> gradient_tables_;  ///< of each cell
};

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
