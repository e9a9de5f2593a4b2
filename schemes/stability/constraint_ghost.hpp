// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>

#include "schemes/system/lattice_system.hpp"

namespace delf {

/// A wave zʲ e^{iθi} with θ = 0 or π and z = 1 or −1 that solves the equations of the action without its constraints,
/// at this and at shorter time steps. Equations that are the same under t → −t depend on z + 1/z, so that z is a double
/// root. A multiplier makes it worse than a ghost: its force λ ∂G/∂φ is all that acts on such a wave off the surface
/// G(φ) = 0. For that of the symmetric rectangle, θ = π and z = −1,
///
///     (z + 2 + 1/z)/k² + λ′ = 0,    λ′ = |u_t|² − |u_x|² in a wave map,
///
/// has z = −e^{±s} with 2 sinh(s/2) = k√λ′, so that the wave grows at the rate s/h ≈ (k/h)√λ′ where λ′ > 0: whatever k
/// is, and faster for a shorter time step. Wave numbers near θ = π, as on a circle of odd N, follow it.
struct ConstraintGhost {
  double theta;
  int z;
};

/// Nothing where there is no multiplier, or more than fields besides them. Constants, θ = 0 and z = 1, are no ghost.
std::optional<ConstraintGhost> ghost_under_constraint(const LatticeSystem&);

/// "waves near theta = pi, z = -1 off the constraint's surface grow from rounding, and faster for a shorter time step".
std::string in_words_under_constraint(const ConstraintGhost&);

/// The remedy: the end of a message.
inline constexpr const char* without_ghost_under_constraint =
    "use a stencil without them, such as lattice.stencil = rectangle";

}  // namespace delf
