// SPDX-License-Identifier: MIT
#pragma once
#include "lattice/plan/solve_plan.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// True if no equation of a slab determines the mean of a field, whichever, and the equations add up to nothing:
///
///     ∂E/∂y·(1, …, 1) = 0,    Σ_i E_i = 0    at any rows
///
/// Such is the potential of the Korteweg–de Vries equation around a circle: with φ every φ + c(t) is a solution, and
/// u = φ_x is that of both. The mean of a row is then a gauge, which a step keeps.
bool has_undetermined_means(const LatticeSystem&, const SolvePlan&);

inline constexpr auto gauge_in_words = "no equation determines the mean of a row, which is that of row 0";

/// The plan; of a system with undetermined means without the unknown of site 0 and its equation, which the others imply.
SolvePlan with_gauge(const LatticeSystem&, SolvePlan);

}  // namespace delf
