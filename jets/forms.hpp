// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <span>

#include "lattice/index.hpp"

namespace delf {

// The forms on a stencil's jets, given its residuals rˡ (∂L/∂yˡ where there is a Lagrangian) and their Jacobian
// J[l][m] = ∂rˡ/∂yᵐ. Values, variations and generators are ordered vertex by vertex, d components each.

/// Θˡ(V) = ∂L/∂yˡ · Vˡ                                    Marsden–Patrick–Shkoller, above (5.3)
inline double cartan_form(int l, int d, std::span<const double> gradient, std::span<const double> V) {
  double sum = 0;
  for (std::size_t i = at(l * d); i < at((l + 1) * d); ++i) sum += gradient[i] * V[i];
  return sum;
}

/// Ωˡ = −dΘˡ; for a variational stencil Σ_l Ωˡ = 0          Marsden–Patrick–Shkoller, after (5.5)
inline double multisymplectic_form(int l, int d, std::span<const double> jacobian, std::span<const double> V,
                                   std::span<const double> W) {
  const std::size_t size = V.size();
  double sum = 0;
  // dΘˡ(V, W) = D(Θˡ·W)[V] − D(Θˡ·V)[W] = Σ_m ∂rˡ/∂yᵐ (Vᵐ Wˡ − Wᵐ Vˡ)
  for (std::size_t i = at(l * d); i < at((l + 1) * d); ++i)
    for (std::size_t m = 0; m < size; ++m) sum -= jacobian[i * size + m] * (V[m] * W[i] - W[m] * V[i]);
  return sum;
}

/// Jˡ(ξ) = ξ ⌟ Θˡ                                         Marsden–Patrick–Shkoller, above (5.7)
inline double momentum_map(int l, int d, std::span<const double> gradient, std::span<const double> generator) {
  return cartan_form(l, d, gradient, generator);
}

}  // namespace delf
