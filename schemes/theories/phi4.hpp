// SPDX-License-Identifier: MIT
#pragma once

namespace delf {

/// ℓ = ½φ_t² − ½φ_x² − ¼λ(φ² − 1)²                         φ_tt − φ_xx + λ(φ³ − φ) = 0
struct PhiFour {
  double lambda = 1;

  auto operator()(const auto& j) const {
    const auto w = j.phi * j.phi - 1.0;
    return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) - (0.25 * lambda) * (w * w);
  }

  /// (N(a) − N(b))/(a − b) = −¼λ(a + b)(a² + b² − 2)
  template <class T>
  T difference_quotient(const T& a, const T& b) const {
    return (-0.25 * lambda) * ((a + b) * (a * a + b * b - 2.0));
  }
};

}  // namespace delf
