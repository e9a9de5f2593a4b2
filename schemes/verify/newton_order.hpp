// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <optional>

#include "lattice/plan/solve_plan.hpp"
#include "schemes/system/lattice_system.hpp"
#include "schemes/verify/check.hpp"

namespace delf {

/// Checks that Newton's method converges quadratically, as it does only if the assembled Jacobian of a slab is the
/// derivative of the slab's equations. `solution` holds consecutive rows that solve them, every component at its own
/// row; multipliers of the newest row need not be there. The unknowns of the newest slab in it are moved at random and
/// found again by full steps, the Jacobian taken anew at each. With e_n the largest error of a field,
///
///     order = log(e_{n+1}/e_n) / log(e_n/e_{n−1}),    value = max(0, 2 − order)
///
/// which is the middle one of the orders from up to five starts, from as far away as the field is large down to 1e-4 of
/// that. Linear equations are solved by the first step, whatever the start: their value is 0. Means that no equation
/// determines are held as steps hold them (with_gauge). Nothing if the rows of the window are too few.
std::optional<Check> check_newton(const LatticeSystem&, const SolvePlan&, const Window& solution, std::uint64_t seed);

}  // namespace delf
