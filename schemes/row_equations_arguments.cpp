// SPDX-License-Identifier: MIT
#include "schemes/row_equations.hpp"

#include <algorithm>
#include <functional>

namespace delf {

void RowEquations::build_arguments(const Mixture& mixture, int most_order) {
  arguments_.emplace(layout_, mixture, most_order);
  RowLook& look = increments_[0].look;
  look.parts = mixture.parts;
  std::ranges::copy(mixture.weights, look.weights);
  increments_have_halos_ = std::ranges::any_of(equations_.bulk[0].terms, [](const Term& t) {
    return t.source == Source::increment && t.shift != 0;
  });
  constexpr int packs_in_cache = 128;  // of the first level
  const int newest = outputs_[0].newest;
  goes_by_strips_ = solver_[0]->can_prepare() && !is_stored_ && layout_.packs() > packs_in_cache &&
                    std::ranges::none_of(equations_.bulk[0].terms, [newest](const Term& t) {
                      return t.source == Source::output && t.age == newest && t.shift != 0;
                    });
}

void RowEquations::find_arguments() {
  for (std::int64_t n = std::max<std::int64_t>(0, n_ + 1 - rows_.rows_held()); n <= n_; ++n) {
    arguments_->begin(n - 1);
    arguments_->find(rows_.y(n, 0), layout_.all());
  }
  arguments_->begin(n_);
}

RowEquations::Advance RowEquations::advance_extrapolated(int order) {
  ArgumentRow row = argument_row();
  arguments_->extrapolate(order, row);
  if (!goes_by_strips_) {
    evaluate_at(row);
    return advance(true);
  }
  const Outputs& o = outputs_[0];
  double* const out = newest_output();
  const auto prepare = [&](PackRange packs) { o.kernel->evaluate_arguments(row, out, packs); };
  // By reference: what is copied into a function would be allocated.
  const RowChange all = solver_[0]->advance_preparing(layout_, right_side(0), increments_[0], std::ref(prepare));
  layout_.fill_halo(out);
  return advanced(all);
}

/// The step after the solver's part of it.
RowEquations::Advance RowEquations::advanced(RowChange all) {
  const Pack beyond = close_new_row();
  return {max_or_nan(all.largest), max_or_nan(max_or_nan(beyond, all.change))};
}

void RowEquations::evaluate_arguments(At at) {
  if (at == At::row) arguments_->find(increments_[0].y, layout_.all());
  evaluate_at(argument_row());
}

ArgumentRow RowEquations::argument_row() {
  ArgumentRow row = arguments_->argument(rows_.y_at(y_slots_(arguments_->mixture().known_row - 1), 0));
  if (positions_.rows()) row.positions = positions_.row(0);
  row.t = static_cast<double>(n_ + outputs_[0].newest) * time_step_;
  row.time_step = time_step_, row.space_step = space_step_;
  return row;
}

/// On a circle each stencil's output is found once: beyond the ends of arcs it is repeated.
void RowEquations::evaluate_at(const ArgumentRow& row) {
  const Outputs& o = outputs_[0];
  double* const out = newest_output();
  o.kernel->evaluate_arguments(row, out, packs_of(o, o.newest, layout_.all()));
  layout_.fill_halo(out);
}

}  // namespace delf
