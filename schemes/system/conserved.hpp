// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "jets/symmetry.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// ξ at each value that a stencil of the family reads, for a symmetry of the fields at one node: it acts alike at every
/// node, on multipliers that are momenta by −Aᵀ, and not at all on others. Throws BadInput if the stencil does not read a
/// field that ξ needs.
void generator(const LatticeSystem&, const StencilFamily&, const LinearSymmetry&, std::span<const double> y,
               std::vector<double>& xi);

/// ξ_a(φ) = Σ_b A_ab φ_b + b_a at the d values of one site.
inline double generator_at(const LinearSymmetry& symmetry, std::size_t a, const double* phi) {
  const std::size_t d = symmetry.shift.size();
  double xi = symmetry.shift[a];
  for (std::size_t b = 0; b < d; ++b) xi += symmetry.matrix[a * d + b] * phi[b];
  return xi;
}

/// Noether's theorem on the slab between two cuts of spacetime (Marsden–Patrick–Shkoller (5.7)): for a symmetry of the
/// Lagrangian with generator ξ, the sum over the stencils that reach across the cut below row `cut`
///
///     J = Σ_Δ Σ_{l: Δˡ at or above the cut} ∂L/∂yˡ · ξ(yˡ)
///
/// is the same at every cut between which the field equations hold. `absolute`, if given, is the sum of |terms|.
double noether_charge(const LatticeSystem&, const Window&, std::int64_t cut, const LinearSymmetry&,
                      double* absolute = nullptr);

}  // namespace delf
