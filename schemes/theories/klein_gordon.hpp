// SPDX-License-Identifier: MIT
#pragma once

namespace delf {

/// ℓ = ½φ_t² − ½φ_x² − ½m²φ²                               φ_tt − φ_xx + m²φ = 0
struct KleinGordon {
  double mass = 1;

  auto operator()(const auto& j) const {
    return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) - (0.5 * mass * mass) * (j.phi * j.phi);
  }

  /// (N(a) − N(b))/(a − b) for N = −½m²φ²
  template <class T>
  T difference_quotient(const T& a, const T& b) const {
    return (-0.5 * mass * mass) * (a + b);
  }
};

}  // namespace delf
