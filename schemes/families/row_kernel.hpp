// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <span>
#include <vector>

#include "jets/discrete_lagrangian.hpp"
#include "jets/numbers/structure.hpp"
#include "schemes/stepping/rows/largest_terms.hpp"
#include "schemes/stepping/rows/row_increment.hpp"
#include "schemes/stepping/rows/row_layout.hpp"

namespace delf {

/// The rows that a slab of stencils reads, one stencil anchored at each site of a row.
struct SlabRows {
  const RowLayout* layout;
  const double* const* values;  ///< values[t·d + a]: component a of the row t above the pattern's lowest vertex
  const double* positions;      ///< x of each slot's site; null unless the family is placed
  double t = 0;                 ///< of the anchors' row
  double time_step, space_step;
  bool near = false;  ///< no |value|, and no sum that evaluate_straight() makes, is above RowKernel::near_below()
  /// Rows that will be wanted next, from where pack 0 begins them: fetched on the way; null: none.
  std::array<const double*, 3> ahead{};
};

/// The rows that an explicit step goes from and to, d of each, and its coefficients. y and v may take the place of what
/// they are made from.
struct ExplicitRows {
  SlabRows now;                                ///< y_n
  const double *const *before, *const *after;  ///< y_n beside the packs of this pass, as many packs as neighbours reach
  const double* const* v_before;
  double *const *v, *const *y;  ///< of row n + 1
  const double* linear;         ///< [a·neighbours + s]
  const double* nonlinear;      ///< [a]
  double stride = 1;            ///< of y += stride v
  double* const* slopes = nullptr;  ///< where ∂ℓ/∂φ(y_n) is kept; null: nowhere
};

/// What a nonlinear part looks at: Σ weight · y(vertex).
struct Argument {
  struct Part {
    Site vertex;
    double weight;
  };
  std::vector<Part> parts;
};

/// A row of arguments m = u + known_weight · known, or of pairs (u, known): what is known of them, and u, which stands
/// in `unknown`, or is extrapolated to there from the rows before it,
///
///     u_{n+1} = Σ_{j=1}^{past_rows} (−1)^{j+1} C(past_rows, j) u_{n+1−j},      u_{n+1−j} = past[j − 1].
struct ArgumentRow {
  static constexpr int most_past_rows = 8;  ///< a loop for each: more would take compilers long
  const RowLayout* layout;
  double* unknown;
  const double* known;
  double known_weight;
  const double* positions = nullptr;  ///< x of each slot's site; null unless the family is placed
  double t = 0;                       ///< of the anchors' row
  double time_step = 0, space_step = 0;
  int past_rows = 0;  ///< 2 … most_past_rows; none: u stands
  const double* const* past = nullptr;
  int read_before = 0, read_after = 0;  ///< so many packs across the ends of arcs: halos of outputs, filled
  bool near = false;  ///< nor is any of what arguments are mixtures of; else u stands
};

/// A step where the matrix is one number: at a row of arguments the output E' is evaluated, and with it
///
///     w(i) = constant + of_neighbours (y(i + 1) − 2y(i) + y(i − 1)) + of_outputs (E'(i) + E(i) + E(i − 1))
///
/// from y and the output E of the row before, halos filled. Of `old` terms of E none, or both.
struct DivisionRows {
  ArgumentRow arguments;
  const double* y;
  const double* old_output;
  double* output;
  double constant = 0, of_neighbours = 0, of_outputs = 0;
  double known_increment = 0;  ///< of straight lines: what is known is less by so much of the increment
};

/// A stencil family evaluated for whole rows: d components at every vertex, i = l·d + a, and the residual split
///
///     r(y) = r(0) + J y + Σ_c weight(c, ·) out_c(y)
///
/// into a part that is linear with constant coefficients and rows of numbers `out_c` that only the nonlinear part
/// needs.
class RowKernel {
 public:
  static constexpr int most_components = 10;  ///< as many as Abstract numbers can tell apart
  virtual ~RowKernel() = default;

  Nonlinearity nonlinearity() const { return nonlinearity_; }
  int outputs() const { return outputs_; }
  /// Outputs may be evaluated on NearPacks where no |value| at a vertex is above this; negative: nowhere.
  double near_below() const { return near_below_; }
  /// The latest vertex time that outputs depend on: below the pattern's latest, they are known before a step.
  int outputs_read_until() const { return outputs_read_until_; }
  /// What the outputs are functions of, the same mixture for every component; empty where it is more than mixtures of
  /// values.
  const std::vector<Argument>& arguments() const { return arguments_; }
  /// What one unit of out_c adds to the residual r[i] of vertex and component i = l·d + a. A direct residual may
  /// part with what r itself has at one vertex, and give each stencil a share of it at several: sums over stencils are
  /// alike.
  double weight(int output, int i) const { return weights_[static_cast<std::size_t>(output * row_size_ + i)]; }

  /// The constant J and r(0) of the split.
  virtual void linear_part(const Cell&, std::span<double> J, std::span<double> r0) const = 0;
  /// The rows out_c for the stencils anchored at each site of some packs of a row; which stencils exist is the caller's
  /// business.
  virtual void evaluate(const SlabRows&, double* const* out, const PackRange&) const = 0;
  void evaluate(const SlabRows& rows, double* const* out) const { evaluate(rows, out, rows.layout->all()); }
  /// The same along straight lines, where this kernel can: the newest row that outputs read is y_n + v_n, for which
  /// y_n stands among the rows.
  virtual bool evaluates_straight() const { return false; }
  virtual void evaluate_straight(const SlabRows&, const double* /*v*/, double* const* /*out*/, const PackRange&) const {}

  /// Whether there is one output, a function of one argument, or of the values of two rows at a site; and that output
  /// for a row of arguments, or of such pairs, halos too.
  virtual bool evaluates_arguments() const { return false; }
  virtual void evaluate_arguments(const ArgumentRow&, double* /*out*/, const PackRange&) const {}

  /// Whether there is a loop for DivisionRows with so many terms of E, whose u is a mixture of so many parts; and that
  /// loop, which makes the new row.
  virtual bool divides(int /*old*/, int /*parts*/) const { return false; }
  virtual RowChange divide(const DivisionRows&, const RowIncrement&) const { return {}; }
  /// The same where u is that of straight lines, y_n + v_n in the place of y_{n+1}: there are no rows of it, and the
  /// new row, its increment and E' may be written over the old ones. The change is that from y_n + v_n: the largest of w.
  virtual RowChange divide_straight(const DivisionRows&, const RowIncrement&) const { return {}; }
  /// How well the row that is there solves w = v − v_before, E' being evaluated at it and kept nowhere.
  virtual LargestTerms measure_division(const DivisionRows&, const RowIncrement&) const { return {}; }

  /// Where the nonlinear part of the equation at a site is that of its own value alone, a step is one loop:
  ///
  ///     w = Σ_s linear(s) (y(i + s) − y(i)) + nonlinear ∂ℓ/∂φ(y(i)),    v += w,    y += stride v
  ///
  /// with the neighbours s listed here; no neighbours where a family has no such loop.
  virtual std::span<const int> explicit_neighbours() const { return {}; }
  /// Returns Σy² of the packs' new values: infinite or NaN where squares overflow.
  virtual double explicit_step(const ExplicitRows&, const PackRange&) const { return 0; }
  /// ∂ℓ/∂φ(y_n) of these packs alone.
  virtual void explicit_slopes(const SlabRows& /*now*/, double* const* /*slopes*/, const PackRange&) const {}

 protected:
  explicit RowKernel(int row_size) : row_size_(row_size) {}

  int row_size_;
  Nonlinearity nonlinearity_ = Nonlinearity::all;
  int outputs_ = 0, outputs_read_until_ = 0;
  double near_below_ = -1;
  std::vector<double> weights_;
  std::vector<Argument> arguments_;
};

}  // namespace delf
