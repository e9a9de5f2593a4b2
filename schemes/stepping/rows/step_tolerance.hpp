// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "schemes/stepping/rows/contraction.hpp"
#include "schemes/stepping/rows/row_equations.hpp"
#include "schemes/stepping/step_method.hpp"

namespace delf {

/// When the iteration of a step by rows may end: what a change δ of its source terms would change y by, Σ gain · max |δ|,
/// against what is allowed.
class StepTolerance {
 public:
  /// The tolerance of equations that iterate. Uses the rows of changes in the table.
  StepTolerance(const LatticeSystem&, const RowEquations&, const RowLayout&, RowTable&, const StepOptions&);

  /// The largest change of y by a change of 1, for each source row.
  const std::vector<double>& gains() const { return gains_; }
  /// The largest change of y by changes of source terms, given the largest |δ| of each.
  double effect_of(const std::vector<double>& changes) const;
  /// Takes the span of row y_n, max y − min y; what is allowed is relative to it from here on.
  void see_span(const RowTable&);
  /// The error at which a prediction or a last correction is good enough, for fields whose largest |y| is `size`.
  double enough(double size) const;
  Contraction& contraction() { return contraction_; }

  void restart() { span_ = 0, contraction_.restart(); }
  void visit(SavedState& state) { state("span", span_), contraction_.visit(state); }

 private:
  const RowEquations& equations_;
  const RowLayout& layout_;
  int d_;
  double tolerance_;
  std::vector<double> gains_;
  Contraction contraction_;
  double span_ = 0;
};

}  // namespace delf
