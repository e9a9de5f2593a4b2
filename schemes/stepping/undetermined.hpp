// SPDX-License-Identifier: MIT
#pragma once
#include "lattice/plan/solve_plan.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// Structural rank is not numerical rank: each equation of a slab may have an unknown of its own, and the Jacobian be
/// singular at every state, as that of y_i + y_{i+1} = r_i on a circle of an even number of sites. Throws BadInput that
/// names values which no equation determines, if it is singular at random states; `turn` is φ(x + L) − φ(x).
void require_determined(const LatticeSystem&, const SolvePlan&, double turn);

}  // namespace delf
