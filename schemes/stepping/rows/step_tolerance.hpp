// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "schemes/stepping/contraction.hpp"
#include "schemes/stepping/rows/row_equations.hpp"
#include "schemes/stepping/step_method.hpp"

namespace delf {

/// When the iteration of a step by rows may end: what a change δ of its source terms would change y by, Σ gain · max |δ|,
/// against what is allowed.
class StepTolerance {
 public:
  /// For equations that iterate. Uses the rows of changes in the table.
  StepTolerance(const LatticeSystem&, const SolvePlan&, const RowEquations&, const RowLayout&, RowTable&,
                const StepOptions&);

  /// Of each source row: what a change of 1 changes y by, at most.
  const std::vector<double>& gains() const { return gains_; }
  /// What the changes of source terms, the largest |δ| of each, would change y by, at most.
  double effect_of(const std::vector<double>& changes) const;
  /// What the row y_n spans, max y − min y; what is allowed is relative to it from here on.
  void see_span(const RowTable&);
  /// For a prediction or a last change, and fields whose largest |y| is `size`; `largest`: that of row n.
  double enough(double size, double largest) { return share(largest) * allowed(size); }
  /// By which one more iteration's change would be less.
  double contraction_now(double largest);
  /// A step from fields of this size may have several roots.
  bool is_stiff(double largest);

  void restart() { span_ = 0, contracts_by_ = -1; }
  void visit(SavedState&);

 private:
  double share(double largest);
  double allowed(double size) const;

  const RowEquations& equations_;
  const RowLayout& layout_;
  int d_;
  double tolerance_;
  Contraction contraction_;
  std::vector<double> gains_;
  double gain_ = 0;  ///< the same for source terms whose weights in an equation sum to 1
  double span_ = 0, contracts_by_ = -1;
};

}  // namespace delf
