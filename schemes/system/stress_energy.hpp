// SPDX-License-Identifier: MIT
#pragma once
#include "jets/batch_density.hpp"

namespace delf {

/// The densities and fluxes at a jet, for the balance laws of translations in time and in space,
///
///     ∂_t(φ_t ∂ℓ/∂φ_t − ℓ) + ∂_x(φ_t ∂ℓ/∂φ_x) = −∂ℓ/∂t        ∂_t(−φ_x ∂ℓ/∂φ_t) + ∂_x(ℓ − φ_x ∂ℓ/∂φ_x) = ∂ℓ/∂x
///
/// whose right-hand sides are there only for densities that depend on t and x themselves. Of densities of second order
/// without φ_tt the energy is φ_t ∂ℓ/∂φ_t + φ_tx ∂ℓ/∂φ_tx − ℓ and the momentum −φ_x ∂ℓ/∂φ_t − φ_xx ∂ℓ/∂φ_tx, up to
/// divergences in space; their fluxes have third derivatives of the field, and are no numbers here.
struct StressEnergy {
  double energy = 0, energy_flux = 0, momentum = 0, momentum_flux = 0;  ///< the four terms, without their derivatives
  double by_t = 0, by_x = 0;                                            ///< ∂ℓ/∂t and ∂ℓ/∂x
};
/// `jet`: all variables of the density, slot by slot.
StressEnergy stress_energy(const BatchDensity&, const double* jet, double t, double x);

}  // namespace delf
