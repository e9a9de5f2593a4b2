// SPDX-License-Identifier: MIT
#pragma once
#include "jets/numbers/dual.hpp"

namespace delf {

/// Two sine-Gordon fields that pull each other along.
///
/// ℓ = Σ_a [½φ_a,t² − ½φ_a,x² + m²(cos φ_a − 1)] + λ(cos(φ₁ − φ₂) − 1)
///
///     φ₁,tt − φ₁,xx + m² sin φ₁ + λ sin(φ₁ − φ₂) = 0
///     φ₂,tt − φ₂,xx + m² sin φ₂ − λ sin(φ₁ − φ₂) = 0
///
struct CoupledSineGordon {
  static constexpr int components = 2;
  double mass = 1, lambda = 1;

  auto operator()(const auto& j) const {
    const auto& [first, second] = j.phi;
    return 0.5 * (j.phi_t[0] * j.phi_t[0] - j.phi_x[0] * j.phi_x[0]) +
           0.5 * (j.phi_t[1] * j.phi_t[1] - j.phi_x[1] * j.phi_x[1]) + (mass * mass) * (cosm1(first) + cosm1(second)) +
           lambda * cosm1(first - second);
  }
};

}  // namespace delf
