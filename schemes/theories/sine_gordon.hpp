// SPDX-License-Identifier: MIT
#pragma once
#include "jets/numbers/sinc.hpp"

namespace delf {

/// ℓ = ½φ_t² − ½φ_x² + m²(cos φ − 1)                       φ_tt − φ_xx + m² sin φ = 0
struct SineGordon {
  double mass = 1;

  auto operator()(const auto& j) const {
    return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) + (mass * mass) * cosm1(j.phi);
  }

  /// (cos a − cos b)/(a − b) = −sin((a+b)/2) sinc((a−b)/2): the quotient itself loses everything when a ≈ b.
  template <class T>
  T difference_quotient(const T& a, const T& b) const {
    return (-mass * mass) * (sin(0.5 * (a + b)) * sinc(0.5 * (a - b)));
  }
};

}  // namespace delf
