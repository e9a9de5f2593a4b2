// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/row_equations.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include "schemes/families/division_loop.hpp"
#include "schemes/stepping/rows/row_equations_step.hpp"
#include "schemes/stepping/rows/row_seed.hpp"

namespace delf {

void RowEquations::build_arguments(const Mixture& mixture, int most_order) {
  arguments_.emplace(layout_, mixture, most_order);
  arguments_->put(positions(), time_step_, space_step_);
  arguments_->set_near_below(outputs_[0].kernel->near_below());
  RowLook& look = increment(0).look;
  look.parts = mixture.parts;
  std::ranges::copy(mixture.weights, look.weights);
  increment(0).v_has_halo = std::ranges::any_of(equations_.bulk[0].terms, [](const Term& t) {
    return t.source == Source::increment && t.shift != 0;
  });
  arguments_->set_read(-outputs_[0].lowest, outputs_[0].highest);
  if (!bricks_ && outputs_[0].kernel->outputs() == 1)
    make_room_for_past_outputs(std::min(most_order, RowSeed::highest_order_of_outputs) + 1);
  // Rows of 640 sites and less stay in the first level of the cache: two loops after each other then take a sixth less
  // than one that has more in hand than there are registers for.
  constexpr int packs_in_cache = 80;
  build_division(mixture, layout_.packs() > packs_in_cache);
}

/// Of bricks those of the next row stand elsewhere.
void RowEquations::make_room_for_past_outputs(int count) {
  Outputs& o = outputs_[0];
  o.held = std::max(o.rows(), count + 1);
  const int period = std::lcm(rows_.rows_held(), rows_.increments_held());
  while (period <= longest_period && std::lcm(period, o.held) > longest_period) ++o.held;
  o.slots = RingSlots(o.held);
  o.ring = RowBuffer(layout_, o.held);
  own_.past_outputs.resize(static_cast<std::size_t>(count));
}

/// What the nonlinear part looks at can then be worked out from y_n and v_n on the way, or from y_{n+1}.
void RowEquations::build_division(const Mixture& mixture, bool in_steps) {
  if (bricks_ || is_stored_ || !solver_[0]->is_a_number()) return;
  const int newest = outputs_[0].newest;
  const double scale = -solver_[0]->right_side_scale(0);
  DivisionRows division{};
  int differences = 0, old = 0;
  bool alike = true;
  for (const Term& t : equations_.bulk[0].terms) {
    if (t.source == Source::unknown) continue;
    const bool beside = t.source == Source::difference && std::abs(t.shift) == 1;
    const bool is_newest = t.source == Source::output && t.age == newest && t.shift == 0;
    const bool is_old = t.source == Source::output && t.age == newest - 1 && (t.shift == 0 || t.shift == -1);
    if (!beside && !is_newest && !is_old) return;
    (beside ? differences : old) += !is_newest;
    double& place = beside ? division.of_neighbours : division.of_outputs;
    const double coefficient = scale * t.coefficient;
    alike = alike && (place == 0 || place == coefficient);
    place = coefficient;
  }
  division.constant = scale * equations_.bulk[0].constant;
  if (!alike || differences != 2 || !outputs_[0].kernel->divides(old, mixture.parts)) return;
  division_ = division;
  divides_in_steps_ = in_steps;
  if (mixture.is_known_alike || mixture.known_row > 2) return;
  on_the_way_ = mixture;
  RowIncrement& rows = increment(0);
  std::ranges::copy(mixture.weights, rows.look.weights);
  rows.v_has_halo = rows.v_has_halo || (in_steps && mixture.parts > 1);
  division_->known_increment = mixture.known_row - 1;
}

double RowEquations::advance_from_outputs(int order) {
  const Outputs& o = outputs_[0];
  put_extrapolated(layout_, here_->past_outputs.data(), order + 1, here_->output);
  layout_.fill_halo(here_->output, -o.lowest, o.highest);
  return make_new_row().largest;
}

void RowEquations::find_arguments() {
  for (std::int64_t n = std::max<std::int64_t>(0, n_ + 1 - rows_.rows_held()); n <= n_; ++n) {
    arguments_->begin(n - 1);
    arguments_->find(rows_.y(n, 0), layout_.all());
  }
  arguments_->begin(n_);
}

const DivisionRows& RowEquations::division(const ArgumentRow& row, double* output) {
  division_->arguments = row;
  division_->y = increment(0).y_before;
  division_->output = output;
  division_->old_output = old_output();
  return *division_;
}

RowChange RowEquations::divide(const ArgumentRow& row, double* output) {
  return outputs_[0].kernel->divide(division(row, output), increment(0));
}

RowChange RowEquations::advance_straight(double largest) {
  const double largest_straight = 3 * with_turn(largest);  // |y_n + v_n| = |2y_n − y_{n−1}|
  RowChange w = divides_straight() ? outputs_[0].kernel->divide_straight(
                                         division(argument_on_the_way(largest_straight), newest_output()), increment(0))
                                   : stream(At::straight_line, {}, largest_straight);
  w.change *= most_weight();
  return w;
}

ArgumentRow RowEquations::argument_on_the_way(double largest) {
  const RowIncrement& rows = increment(0);
  return {.layout = &layout_,
          .unknown = nullptr,
          .known = rows.y_before + static_cast<std::ptrdiff_t>(on_the_way_->known_site) * lanes,
          .known_weight = on_the_way_->known_weight,
          .positions = positions(),
          .t = time_of_outputs(),
          .time_step = time_step_,
          .space_step = space_step_,
          .read_before = -outputs_[0].lowest,
          .read_after = outputs_[0].highest,
          .near = largest <= outputs_[0].kernel->near_below()};
}

void RowEquations::evaluate_arguments(At at) {
  if (at == At::row) arguments_->find(increment(0).y, layout_.all());
  evaluate_at(argument_row());
}

}  // namespace delf
