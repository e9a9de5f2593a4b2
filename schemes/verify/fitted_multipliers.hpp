// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// Gives rows the multipliers of constraints that fit their equations best, where all rows that an equation reads are there;
/// fixed sites keep theirs. E_a = F_a + Σ_m λ_m ∂G_m/∂φ_a, and the components of E along all ∂G_m/∂φ are zero:
///
///     Σ_m (∂G_l/∂φ · ∂G_m/∂φ) λ_m = −∂G_l/∂φ · F
void fit_multipliers(const LatticeSystem&, Window& rows);

}  // namespace delf
