// SPDX-License-Identifier: MIT
#pragma once
#include "jets/simd/pack_math.hpp"

namespace delf {

/// Sine-Gordon with an impurity of strength ε and width w at x₀: a place where the potential is deeper (ε > 0) or
/// shallower, on which kinks scatter. The Lagrangian depends on x, and the type says so.
///
/// ℓ = ½φ_t² − ½φ_x² + m²(1 + ε exp(−((x − x₀)/w)²))(cos φ − 1)
struct SineGordonImpurity {
  static constexpr bool placed = true;
  double mass = 1, strength = 0.5, width = 1, position = 0;

  auto operator()(const auto& j) const {
    const auto s = (1.0 / width) * (j.x - position);
    const auto depth = (mass * mass) * (1.0 + strength * exp(-(s * s)));
    return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) + depth * cosm1(j.phi);
  }
};

}  // namespace delf
