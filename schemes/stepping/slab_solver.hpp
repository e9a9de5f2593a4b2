// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/solvers/block_solver.hpp"
#include "schemes/system/assembly.hpp"

namespace delf {

/// A solver for the Jacobian of a slab's equations: places that are not `present` are no couplings to it.
inline BlockSolver solver_of(const Assembly& slab, const std::vector<char>& present) {
  std::vector<std::pair<int, int>> places;
  places.reserve(slab.places().size());
  for (const auto& [equation, unknown] : slab.places()) places.emplace_back(equation, unknown);
  return {slab.size(), places, present, slab.matched()};
}
/// The solver of a slab, without couplings that cancel between stencils.
inline BlockSolver solver_of(const Assembly& slab) { return solver_of(slab, slab.present()); }

}  // namespace delf
