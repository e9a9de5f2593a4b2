// SPDX-License-Identifier: MIT
#pragma once
#include "jets/batch_density.hpp"

namespace delf {

/// Derivatives of ℓ in φ alone, at (φ, 0, …), that force gradients are made of; slots hold φ alone. Densities that know
/// them are of this class too.
class ValueDerivatives {
 public:
  virtual ~ValueDerivatives() = default;

  /// BatchDensity::slope and ::curvature at once: g[a][i] = ∂ℓ/∂φᵃ, c[a·d + b][i] = ∂²ℓ/∂φᵃ∂φᵇ.
  virtual void slope_and_curvature(const JetBatch& phi, double* const* g, double* const* c) const = 0;
  /// The derivative of the curvature along v: c[a·d + b][i] = Σ_e v[e][i] ∂³ℓ/∂φᵃ∂φᵇ∂φᵉ.
  virtual void curvature_along(const JetBatch& phi, const double* const* v, double* const* c) const = 0;
};

}  // namespace delf
