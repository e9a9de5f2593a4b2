// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// Gives rows the multipliers of one constraint that fit their equations best, where all rows that an equation reads are
/// there; fixed sites keep theirs. E_a = F_a + λ ∂G/∂φ_a, and the component of E along ∂G/∂φ is zero:
///
///     λ = −Σ_a F_a ∂G/∂φ_a / Σ_a (∂G/∂φ_a)²
void fit_multipliers(const LatticeSystem&, Window& rows);

}  // namespace delf
