// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <vector>

#include "jets/discrete_lagrangian.hpp"
#include "jets/structure.hpp"
#include "lattice/stencil_shape.hpp"
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

/// One kind of stencil all over the lattice. A stencil carries one residual rˡ for each vertex, ∂L/∂yˡ where there is a
/// Lagrangian; solver, plan and checks see only r and its Jacobian. The residual is split
///
///     r(y) = r(0) + J y + Σ_c weight(c, ·) out_c(y)
///
/// into a part that is linear with constant coefficients and rows of numbers `out_c` that only the nonlinear part
/// needs, computed for a whole row of stencils at once. Values are ordered vertex by vertex, d components each.
class StencilFamily {
 public:
  virtual ~StencilFamily() = default;

  const StencilPattern& pattern() const { return pattern_; }
  int components() const { return components_; }
  int size() const { return pattern_.size() * components_; }
  Nonlinearity nonlinearity() const { return nonlinearity_; }
  bool is_variational() const { return variational_; }
  bool is_placed() const { return placed_; }
  int outputs() const { return outputs_; }
  /// The latest vertex time that outputs depend on: below the pattern's latest, they are known before a step.
  int outputs_read_until() const { return outputs_read_until_; }
  /// What one unit of out_c adds to the residual r[i] of vertex and component i = l·d + a.
  double weight(int output, int i) const { return weights_[static_cast<std::size_t>(output * size() + i)]; }

  /// r, for one stencil.
  virtual void residual(const Cell&, std::span<const double> y, std::span<double> r) const = 0;
  /// ∂r/∂y, row by row.
  virtual void jacobian(const Cell&, std::span<const double> y, std::span<double> J) const = 0;
  /// The constant J and r(0) of the split.
  virtual void linear_part(const Cell&, std::span<double> J, std::span<double> r0) const = 0;
  /// The rows out_c[0 … M−1] for the stencils anchored at each site of a row; halos and stencils that do not exist are
  /// the caller's business.
  virtual void evaluate(const SlabRows&, double* const* out) const = 0;

 protected:
  StencilFamily(StencilPattern pattern, int components, bool variational)
      : pattern_(std::move(pattern)), components_(components), variational_(variational) {}

  StencilPattern pattern_;
  int components_;
  bool variational_, placed_ = false;
  Nonlinearity nonlinearity_ = Nonlinearity::all;
  int outputs_ = 0, outputs_read_until_ = 0;
  std::vector<double> weights_;
};

}  // namespace delf
