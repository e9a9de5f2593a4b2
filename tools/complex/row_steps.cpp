// SPDX-License-Identifier: MIT
#include "tools/complex/row_steps.hpp"

#include <algorithm>

#include "schemes/complex/circle_fibre.hpp"
#include "schemes/stepping/saved_state.hpp"

namespace delf {

RowSteps::RowSteps(const ComplexScene& scene) : scene_(scene) {
  if (scene.step_control()) reversible_.emplace(*scene.space, scene.scene.problem.time_step, *scene.step_control());
}

void RowSteps::start(SpaceEvolution& evolution) {
  const std::vector<double> values = scene_.values(), rates = scene_.rates();
  evolution.start(values, rates, reversible_ ? reversible_->first(values, rates) : scene_.time_step(0));
  next_ = 1, direction_ = 1;
  check(evolution);
}

void RowSteps::step(SpaceEvolution& evolution) {
  evolution.step(reversible_ ? reversible_->next(evolution) : scene_.time_step(next_));
  next_ += direction_;
  check(evolution);
}

std::optional<double> RowSteps::first_lengths(const SpaceEvolution& evolution) const {
  if (!reversible_) return {};
  return std::min(evolution.last_step(), reversible_->plain(evolution));
}

void RowSteps::check(const SpaceEvolution& evolution) const {
  if (scene_.scene.problem.circle_valued)
    check_wrapped_differences(scene_.space->mesh, evolution.row(), evolution.row(1));
}

void RowSteps::visit(SavedState& state) {
  state("place in the list of steps", next_), state("direction of steps", direction_);
  if (reversible_) reversible_->visit(state);
}

void RowSteps::turn_back(SpaceEvolution& evolution) {
  evolution.turn_back();
  direction_ = -direction_;
  next_ += 2 * direction_;  // the last step is between the two rows that are there
}

}  // namespace delf
