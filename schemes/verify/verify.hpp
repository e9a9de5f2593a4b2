// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "jets/symmetry.hpp"
#include "lattice/plan/solve_plan.hpp"
#include "schemes/system/lattice_system.hpp"
#include "schemes/verify/check.hpp"

namespace delf {

struct VerifyOptions {
  double tolerance = 1e-13;
  int variations = 2;                      ///< pairs of V and W, of either sort, for each region
  std::uint64_t seed = 1;                  ///< of regions and variations
  std::vector<LinearSymmetry> symmetries;  ///< to try Noether's theorem with
  int data_rows = 2;                       ///< rows from row 0 on that the run was started from
};

/// Everything that can be asked of some consecutive rows of a section at once: the field equations on every row that
/// has its neighbours, the form formula (5.6) on regions of every kind with variations evolved and local, the
/// symplectic form from row to row, and Noether's theorem (5.7). Every component stands at its own row, and the first
/// row is even. For long runs use the parts (EquationCheck, FormCheck, NoetherCheck), which look at rows as they come.
///
/// Throws BadInput if the rows are too few for a region with an interior.
std::vector<Check> verify(const LatticeSystem&, const SolvePlan&, const Window& rows, const VerifyOptions& = {});

}  // namespace delf
