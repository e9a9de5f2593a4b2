// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <numbers>
#include <span>

#include "lattice/error.hpp"

namespace delf {

/// Where a field takes its values. ℝⁿ is n components in ℝ; on S¹ = ℝ/2π only differences modulo 2π mean anything.
enum class Fibre { real, circle };

/// The representative of a difference modulo 2π that lies in [−π, π].
inline double wrap(double difference) {
  return std::remainder(difference, 2 * std::numbers::pi);
}

/// Above this a wrapped difference says nothing about which way round the field went.
inline constexpr double largest_wrapped_difference = 0.9 * std::numbers::pi;

/// S¹: wrapping happens once, in the gather: y_l ← y_1 + wrap(y_l − y_1). Everything after it, differentiation above
/// all, sees real numbers. Marsden–Patrick–Shkoller, after (5.10).
/// Throws NotFinite when a wrapped difference is above 0.9π.
inline void lift_to_first_vertex(std::span<double> values) {
  for (double& y : values.subspan(1)) {
    const double difference = wrap(y - values[0]);
    if (!(std::abs(difference) <= largest_wrapped_difference))
      throw NotFinite("a difference on the circle is " + std::to_string(difference) +
                      ", above 0.9 pi: values so far apart cannot be told from their complement; refine the lattice");
    y = values[0] + difference;
  }
}

}  // namespace delf
