// SPDX-License-Identifier: MIT
#pragma once
#include "jets/batch_density.hpp"

namespace delf {

/// What flows where at a jet: for the balance laws of translations in time and in space,
///
///     ∂_t(φ_t ∂ℓ/∂φ_t − ℓ) + ∂_x(φ_t ∂ℓ/∂φ_x) = −∂ℓ/∂t        ∂_t(−φ_x ∂ℓ/∂φ_t) + ∂_x(ℓ − φ_x ∂ℓ/∂φ_x) = ∂ℓ/∂x
///
/// whose right-hand sides are there only for densities that depend on t and x themselves.
struct StressEnergy {
  double energy = 0, energy_flux = 0, momentum = 0, momentum_flux = 0;  ///< the four terms, without their derivatives
  double by_t = 0, by_x = 0;                                            ///< ∂ℓ/∂t and ∂ℓ/∂x
};
/// `phi`, `phi_t`, `phi_x`: d numbers each.
StressEnergy stress_energy(const BatchDensity&, const double* phi, const double* phi_t, const double* phi_x, double t,
                           double x);

}  // namespace delf
