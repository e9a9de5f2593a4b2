// SPDX-License-Identifier: MIT
#pragma once
#include <numbers>

#include "schemes/states/jacobi.hpp"

namespace delf::initial {

/// A row of sine-Gordon kinks that gains 2π in each period Λ and moves with speed v (Marsden–Patrick–Shkoller §5.2):
///
///     φ̃(ξ) = π + 2 am(2Kξ/Λ; κ),    mΛ = 2κK √(1 − v²)
///
struct TrainProfile {
  Jacobi jacobi;
  double period, speed;

  double phi(double xi) const;
  /// dφ̃/dξ
  double slope(double xi) const;
  /// √(1 − v²)/m = Λ/2κK, of each kink
  double width() const { return period / (2 * jacobi.modulus() * jacobi.K()); }

  /// A train of κ = 1 − ε; speed follows. Throws BadInput (initial.epsilon) if the kinks are too wide for the period.
  static TrainProfile from_epsilon(double epsilon, double period, double mass);
  /// A train of speed v; κ follows. Throws BadInput (initial.speed) if they are further apart than numbers can tell.
  static TrainProfile from_speed(double speed, double period, double mass);
};

}  // namespace delf::initial
