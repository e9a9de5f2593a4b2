// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>

#include "schemes/stepping/newton.hpp"
#include "schemes/stepping/saved_state.hpp"

namespace delf {

/// What one more iteration of a step's fixed point would change, at most, for fields up to a size: found anew when
/// fields outgrow the last one.
class Contraction {
 public:
  Contraction(const LatticeSystem& system, const SolvePlan& plan)
      : system_(&system), plan_(&plan), bound_(fixed_point_bound(system, plan, amplitude_)) {}

  /// Whether a step from fields of this size may have several roots.
  bool is_stiff(double largest) {
    // The bound of a polynomial potential grows with the field: that of larger fields than there are calls a plain step
    // stiff. One for half as much again as there is, if it is far from stiff, says what is.
    if (!is_stiff() || amplitude_ != at_first || 1.5 * largest >= at_first) return is_stiff();
    amplitude_ = 1.5 * largest;
    if (const auto here = fixed_point_bound(*system_, *plan_, amplitude_))
      if (here->nonlinear < 0.2 * here->dominance) bound_ = here;
    return is_stiff();
  }

  /// Whether next_change() must be asked anew for fields of this size.
  bool is_outgrown(double largest) const { return largest > amplitude_ && largest < 1e100; }

  /// The next change of y_{n+1} over the last change of what the nonlinear part looks at, whose weights at the unknown
  /// row sum to `weight`; four times the worst case, and infinite where nothing is known. `gain` is the row equations'
  /// own sharper 1/dominance, if it is not zero.
  double next_change(double largest, double weight, double gain) {
    if (!bound_) return std::numeric_limits<double>::infinity();
    if (is_outgrown(largest)) {
      amplitude_ = 2 * largest;
      if (const auto wider = fixed_point_bound(*system_, *plan_, amplitude_))
        bound_->nonlinear = std::max(bound_->nonlinear, wider->nonlinear);
    }
    const double crude =
        bound_->dominance > 0 ? 1 / (bound_->dominance * weight) : std::numeric_limits<double>::infinity();
    return 4 * bound_->nonlinear * (gain > 0 ? std::min(gain, crude) : crude);
  }

  void visit(SavedState& state) { state("contraction amplitude", amplitude_), state("contraction bound", bound_); }

 private:
  static constexpr double at_first = std::numbers::pi;

  bool is_stiff() const { return bound_ && bound_->nonlinear > 0.9 * bound_->dominance; }

  const LatticeSystem* system_;
  const SolvePlan* plan_;
  double amplitude_ = at_first;
  std::optional<FixedPointBound> bound_;
};

}  // namespace delf
