// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "lattice/solve_plan.hpp"
#include "schemes/lattice_system.hpp"

namespace delf {

struct NewtonResult {
  bool converged = false;
  int iterations = 0;
  bool continued = false;       ///< continuation in h was needed
  std::vector<double> row;      ///< the unknown row, row[i·d + a]
};

/// Solves the slab whose unknown row follows `past` (its last row is the newest known) by full Newton steps from
/// `seed`. Where the equations may have several roots, the one is wanted that h → 0 leads to: Newton's root is taken
/// only if the Jacobian is definite all the way from the seed to it, otherwise the root is followed from a small h,
/// and given up if the path turns back. Never another root in silence.
NewtonResult solve_slab(const LatticeSystem&, const SolvePlan&, const Window& past, const std::vector<double>& seed,
                        double tolerance, int max_iterations);

/// Row 1 from row 0 and φ_t: the equation at row 0 with y₋₁ = y₁ − 2hφ_t.
NewtonResult solve_centred_start(const LatticeSystem&, const SolvePlan&, const Window& row0,
                                 const std::vector<double>& velocity, double tolerance, int max_iterations);

}  // namespace delf
