// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <limits>
#include <vector>

#include "schemes/stepping/rows/row_equations.hpp"
#include "schemes/stepping/saved_state.hpp"

namespace delf {

/// The contraction of a step's fixed point, in the largest norm: y_{n+1} enters a quadrature value m_j with weights
/// that sum to W_j, and a change of 1 in the source term g_s changes y^a by at most G_as, so that a change of y_{n+1}
/// is the next time less by
///
///     q = max_a Σ_s G_as max Σ_j W_j |∂g_s/∂m_j|.
///
/// Where q < 1 for all fields between a prediction and a root there is no other root among them.
class Contraction {
 public:
  /// gains[s][a] = G_as
  Contraction(const RowEquations&, std::vector<std::vector<double>> gains);

  /// q for fields whose largest |y| is `size`, in the step from row n. It is found anew, for larger fields than these,
  /// when they outgrow those that it was found for.
  double within(double size, std::int64_t n);
  /// A step from fields of this size may have several roots, by q for all fields that are no larger.
  bool is_stiff(double size, std::int64_t n) { return !(within(size, n) < single_root); }
  /// True if the step is stiff for the fields on the way from row n to row n + 1, both as they are in the table.
  bool is_stiff_along(const RowTable&, std::int64_t n);
  /// The next change of y_{n+1} over its last change: four times the worst case.
  double next_change(double size, std::int64_t n) { return 4 * (is_stiff(size, n) ? std::min(along_, within_) : within_); }

  const std::vector<std::vector<double>>& gains() const { return gains_; }

  void restart() { size_ = -1, within_ = 0, along_ = std::numeric_limits<double>::infinity(); }
  void visit(SavedState& state) {
    state("contraction size", size_), state("contraction", within_), state("contraction along", along_);
  }

 private:
  /// Short of 1: rows near walls have other weights than those of the bulk, which q is found from.
  static constexpr double single_root = 0.9;

  double of(const std::vector<double>& slopes) const;

  const RowEquations& equations_;
  std::vector<std::vector<double>> gains_;
  double size_ = -1, within_ = 0;
  double along_ = std::numeric_limits<double>::infinity();  ///< q of the last step that was checked along its way
};

}  // namespace delf
