// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <vector>

#include "jets/discrete_lagrangian.hpp"
#include "jets/structure.hpp"
#include "schemes/row_layout.hpp"

namespace delf {

/// The rows that a slab of stencils reads, one stencil anchored at each site of a row.
struct SlabRows {
  const RowLayout* layout;
  const double* const* values;  ///< values[t·d + a]: component a of the row t above the pattern's lowest vertex
  const double* positions;      ///< x of each slot's site; null unless the family is placed
  double t = 0;                 ///< of the anchors' row
  double time_step, space_step;
};

/// A stencil family evaluated for whole rows: d components at every vertex, i = l·d + a, and the residual split
///
///     r(y) = r(0) + J y + Σ_c weight(c, ·) out_c(y)
///
/// into a part that is linear with constant coefficients and rows of numbers `out_c` that only the nonlinear part
/// needs.
class RowKernel {
 public:
  virtual ~RowKernel() = default;

  Nonlinearity nonlinearity() const { return nonlinearity_; }
  int outputs() const { return outputs_; }
  /// The latest vertex time that outputs depend on: below the pattern's latest, they are known before a step.
  int outputs_read_until() const { return outputs_read_until_; }
  /// What one unit of out_c adds to the residual r[i] of vertex and component i = l·d + a.
  double weight(int output, int i) const { return weights_[static_cast<std::size_t>(output * row_size_ + i)]; }

  /// The constant J and r(0) of the split.
  virtual void linear_part(const Cell&, std::span<double> J, std::span<double> r0) const = 0;
  /// The rows out_c[0 … M−1] for the stencils anchored at each site of a row; halos and stencils that do not exist are
  /// the caller's business.
  virtual void evaluate(const SlabRows&, double* const* out) const = 0;

 protected:
  explicit RowKernel(int row_size) : row_size_(row_size) {}

  int row_size_;
  Nonlinearity nonlinearity_ = Nonlinearity::all;
  int outputs_ = 0, outputs_read_until_ = 0;
  std::vector<double> weights_;
};

}  // namespace delf
