// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <vector>

#include "schemes/system/lattice_system.hpp"
#include "schemes/verify/check.hpp"

namespace delf {

/// Checks that the action J of a jump between two traces agrees with that of the cells: where the jump closes, the
/// momenta of its traces are those of the density,
///
///     ∂₊J(q, q) = ∂ℓ/∂q̇ = −∂₋J(q, q)
///
/// and a value between the two has none. One check for each family that joins traces, at the given fields; none for
/// schemes without traces. A gauge that acts on jumps alone is variational, and keeps the form: only this finds it.
std::vector<Check> check_fluxes(const LatticeSystem&, std::span<const double> fields, double tolerance = 1e-12);

}  // namespace delf
