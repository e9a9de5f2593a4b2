// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "jets/symmetry.hpp"

namespace delf {

/// A complex field φ = φ₁ + iφ₂, with a charge.
///
/// ℓ = ½|φ_t|² − ½|φ_x|² − ½m²|φ|² − ¼λ|φ|⁴                φ_tt − φ_xx + m²φ + λ|φ|²φ = 0
struct ComplexKleinGordon {
  static constexpr int components = 2;
  double mass = 1, lambda = 1;

  auto operator()(const auto& j) const {
    const auto squared = [](const auto& z) { return z[0] * z[0] + z[1] * z[1]; };
    const auto s = squared(j.phi);
    return 0.5 * (squared(j.phi_t) - squared(j.phi_x)) - (0.5 * mass * mass) * s - (0.25 * lambda) * (s * s);
  }

  /// φ ↦ e^{iε}φ
  static std::vector<LinearSymmetry> symmetries() { return {{"charge_u1", {0, -1, 1, 0}, {0, 0}}}; }
};

}  // namespace delf
