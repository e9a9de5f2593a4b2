// SPDX-License-Identifier: MIT
#include "schemes/row_equations.hpp"

#include <algorithm>

namespace delf {

void RowEquations::build_arguments(const Mixture& mixture, int most_order) {
  arguments_.emplace(layout_, mixture, most_order);
  RowLook& look = increments_[0].look;
  look.parts = mixture.parts;
  std::ranges::copy(mixture.weights, look.weights);
}

void RowEquations::find_arguments() {
  for (std::int64_t n = std::max<std::int64_t>(0, n_ + 1 - rows_.rows_held()); n <= n_; ++n) {
    arguments_->begin(n - 1);
    arguments_->find(rows_.y(n, 0), layout_.all());
  }
  arguments_->begin(n_);
}

void RowEquations::evaluate_extrapolated(int order) {
  ArgumentRow row = argument_row();
  arguments_->extrapolate(order, row);
  evaluate_at(row);
}

void RowEquations::evaluate_arguments(At at) {
  if (at == At::row) arguments_->find(increments_[0].y, layout_.all());
  evaluate_at(argument_row());
}

ArgumentRow RowEquations::argument_row() {
  ArgumentRow row = arguments_->argument(increments_[0].y_before);
  if (positions_.rows()) row.positions = positions_.row(0);
  row.t = static_cast<double>(n_ + outputs_[0].newest) * time_step_;
  row.time_step = time_step_, row.space_step = space_step_;
  return row;
}

/// On a circle each stencil's output is found once: beyond the ends of arcs it is repeated.
void RowEquations::evaluate_at(const ArgumentRow& row) {
  Outputs& o = outputs_[0];
  double* const out = o.ring.row(o.slots(-o.newest));
  o.kernel->evaluate_arguments(row, out, packs_of(o, o.newest, layout_.all()));
  layout_.fill_halo(out);
}

}  // namespace delf
