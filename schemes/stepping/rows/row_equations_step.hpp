// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/families/division_loop.hpp"
#include "schemes/stepping/rows/row_equations.hpp"

namespace delf {

// What a step of a short row goes through besides its loops. Inlined into it: calls, and what they save and look up
// again, cost as much as some packs.

[[gnu::always_inline]] inline void RowEquations::begin(std::int64_t n) {
  n_ = n;
  in_place_ = false;
  if (is_one_loop()) return;
  find_rows();
  if (arguments_) begin_arguments();
}

[[gnu::always_inline]] inline void RowEquations::begin_arguments() {
  arguments_->begin(n_);
  increment(0).look.argument = arguments_->row(0);
}

[[gnu::always_inline]] inline void RowEquations::find_rows() {
  const std::int64_t place = rows_.place(n_);
  if (places_.empty()) {
    find_rows_at(place);
  } else {
    period_.at(place);
    here_ = &places_[static_cast<std::size_t>(period_.slot())];
    if (is_streamed_) own_rows();
  }
  let_sums_read_here();
}

/// Bricks are those of the equations' row.
inline void RowEquations::let_sums_read_here() {
  summed_ = {here_->bases.data(), static_cast<int>((n_ + 1 - equations_.bulk[0].shift) & 1)};
}

[[gnu::always_inline]] inline RowChange RowEquations::advance_extrapolated(int order, double largest) {
  const ArgumentRow& row = argument_row();
  arguments_->extrapolate(order, with_turn(largest));
  return advance_at(row);
}

inline RowChange RowEquations::advance_again(double largest) {
  const ArgumentRow& row = argument_row();
  arguments_->set_largest(with_turn(largest));
  return advance_at(row);
}

[[gnu::always_inline]] inline RowChange RowEquations::advance_at(const ArgumentRow& row) {
  if (divides_in_steps_ && row.near && row.past_rows <= most_past_rows_divided) return divide(row, here_->output);
  evaluate_at(row);
  return make_new_row();
}

inline const ArgumentRow& RowEquations::argument_row() {
  return arguments_->argument(here_->known_values, time_of_outputs());
}

/// On a circle each stencil's output is found once: beyond the ends of arcs it is repeated.
[[gnu::always_inline]] inline void RowEquations::evaluate_at(const ArgumentRow& row) {
  const Outputs& o = outputs_[0];
  o.kernel->evaluate_arguments(row, here_->output, packs_of(o, o.newest, layout_.all()));
}

[[gnu::always_inline]] inline RowChange RowEquations::make_new_row() {
  if (is_stored_) store_right_sides();
  if (!equations_.exceptional.empty()) set_exceptional_sites();
  const bool odd = solver_[1] && (n_ + 1) % 2 != 0;
  return solver_[odd ? 1 : 0]->advance(layout_, d_, right_sides_.data(), here_->increments.data(), w_rows_.data());
}

}  // namespace delf
