// SPDX-License-Identifier: MIT
#include "schemes/row_equations.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include "schemes/division_loop.hpp"
#include "schemes/row_equations_step.hpp"
#include "schemes/row_seed.hpp"

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
  if (layout_.packs() > packs_in_cache) build_division(mixture), build_straight_lines(mixture);
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

void RowEquations::build_division(const Mixture& mixture) {
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
  if (alike && differences == 2 && outputs_[0].kernel->divides(old, mixture.parts)) division_ = division;
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

RowChange RowEquations::divide(const ArgumentRow& row, double* output, bool along_straight_lines) {
  const RowKernel& kernel = *outputs_[0].kernel;
  const RowIncrement& rows = increment(0);
  division_->arguments = row;
  division_->y = rows.y_before;
  division_->output = output;
  division_->old_output = old_output();
  return along_straight_lines ? kernel.divide_straight(*division_, rows) : kernel.divide(*division_, rows);
}

/// Where a step is one loop, what the nonlinear part looks at can be worked out from y_n and v_n on the way.
void RowEquations::build_straight_lines(const Mixture& mixture) {
  if (!division_ || mixture.is_known_alike || mixture.known_row > 2) return;
  straight_ = mixture;
  RowIncrement& rows = increment(0);
  std::ranges::copy(mixture.weights, rows.look.weights);
  rows.v_has_halo = rows.v_has_halo || mixture.parts > 1;
  division_->known_increment = mixture.known_row - 1;
}

RowChange RowEquations::advance_straight(double largest) {
  const double largest_straight = 3 * with_turn(largest);  // |y_n + v_n| = |2y_n − y_{n−1}|
  RowChange w = straight_ ? divide_straight(largest_straight) : stream(At::straight_line, {}, largest_straight);
  w.change *= most_weight();
  return w;
}

RowChange RowEquations::divide_straight(double largest_straight) {
  const RowIncrement& rows = increment(0);
  ArgumentRow row{.layout = &layout_,
                  .unknown = nullptr,
                  .known = rows.y_before + static_cast<std::ptrdiff_t>(straight_->known_site) * lanes,
                  .known_weight = straight_->known_weight,
                  .positions = positions(),
                  .t = time_of_outputs(),
                  .time_step = time_step_,
                  .space_step = space_step_,
                  .read_before = -outputs_[0].lowest,
                  .read_after = outputs_[0].highest,
                  .near = largest_straight <= outputs_[0].kernel->near_below()};
  return divide(row, newest_output(), true);
}

void RowEquations::evaluate_arguments(At at) {
  if (at == At::row) arguments_->find(increment(0).y, layout_.all());
  evaluate_at(argument_row());
}

}  // namespace delf
