// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <numbers>

namespace delf {

/// The space of a field's values. ℝⁿ is n components in ℝ; on S¹ = ℝ/2π only differences modulo 2π mean anything.
enum class Fibre { real, circle };

/// The representative of a difference modulo 2π that lies in [−π, π].
inline double wrap(double difference) {
  return std::remainder(difference, 2 * std::numbers::pi);
}

/// Above this a wrapped difference says nothing about which way round the field went.
inline constexpr double largest_wrapped_difference = 0.9 * std::numbers::pi;

}  // namespace delf
