// SPDX-License-Identifier: MIT
#pragma once
#include "jets/numbers/sinc.hpp"

namespace delf {

/// One angle q: sine-Gordon at one point of space. A pendulum of length L under gravity g has m² = g/L.
///
/// ℓ = ½q_t² + m²(cos q − 1)                               q_tt + m² sin q = 0
struct Pendulum {
  double mass = 1;

  auto operator()(const auto& j) const { return 0.5 * (j.phi_t * j.phi_t) + (mass * mass) * cosm1(j.phi); }

  /// (cos a − cos b)/(a − b) = −sin((a+b)/2) sinc((a−b)/2)
  template <class T>
  T difference_quotient(const T& a, const T& b) const {
    return (-mass * mass) * (sin(0.5 * (a + b)) * sinc(0.5 * (a - b)));
  }
};

}  // namespace delf
