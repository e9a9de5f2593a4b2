// SPDX-License-Identifier: MIT
#pragma once
#include "jets/batch_density.hpp"

namespace delf {

/// An estimate of the highest frequency ω of small waves of a theory about a constant field, for wave numbers up to q. Each
/// component a has
///
///     M ω² = C ω + K,    M = Σ_b |∂²ℓ/∂φ_tᵃ∂φ_tᵇ|,    C = Σ_b |∂²ℓ/∂φᵃ∂φ_tᵇ − ∂²ℓ/∂φ_tᵃ∂φᵇ| + 2q Σ_b |∂²ℓ/∂φ_tᵃ∂φ_xᵇ|,
///     K = max (Σ_b |∂²ℓ/∂φᵃ∂φᵇ|, q² Σ_b |∂²ℓ/∂φ_xᵃ∂φ_xᵇ|, q⁴ Σ_b |∂²ℓ/∂φ_xxᵃ∂φ_xxᵇ|),
///
/// so that ω = cq for waves of speed c; the highest of them is returned, or 0. For densities without t and x.
double highest_frequency(const BatchDensity&, double constant, double q);

}  // namespace delf
