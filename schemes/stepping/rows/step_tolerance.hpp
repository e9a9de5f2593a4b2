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
  /// For equations that iterate. Uses the rows of changes in the table.
  StepTolerance(const LatticeSystem&, const RowEquations&, const RowLayout&, RowTable&, const StepOptions&);

  /// Of each source row: what a change of 1 changes y by, at most.
  const std::vector<double>& gains() const { return gains_; }
  /// What the changes of source terms, the largest |δ| of each, would change y by, at most.
  double effect_of(const std::vector<double>& changes) const;
  /// What the row y_n spans, max y − min y; what is allowed is relative to it from here on.
  void see_span(const RowTable&);
  /// For a prediction or a last change, and fields whose largest |y| is `size`, where one more iteration's change would
  /// be less by `contraction`.
  double enough(double size, double contraction) const { return share(contraction) * allowed(size); }
  Contraction& contraction() { return contraction_; }

  void restart() { span_ = 0, contraction_.restart(); }
  void visit(SavedState& state) { state("span", span_), contraction_.visit(state); }

 private:
  double share(double contraction) const;
  double allowed(double size) const;

  const RowEquations& equations_;
  const RowLayout& layout_;
  int d_;
  double tolerance_;
  std::vector<double> gains_;
  Contraction contraction_;
  double span_ = 0;
};

}  // namespace delf
