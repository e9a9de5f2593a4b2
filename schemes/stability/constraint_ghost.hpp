// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>

#include "schemes/stability/linear_stability.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// A ghost of the action without its constraints, at this and at shorter time steps. A multiplier makes it worse than a
/// ghost: its force λ ∂G/∂φ is all that acts on such a wave off the surface G(φ) = 0. For the double root z = −1 of the
/// symmetric rectangle at θ = π,
///
///     (z + 2 + 1/z)/k² + λ′ = 0,    λ′ = |u_t|² − |u_x|² in a wave map,
///
/// has z = −e^{±s} with 2 sinh(s/2) = k√λ′, so that the wave grows at the rate s/h ≈ (k/h)√λ′ where λ′ > 0: whatever k
/// is, and faster for a shorter time step. Wave numbers near θ = π, as on a circle of odd N, follow it.
///
/// Nothing where there is no multiplier, or more than fields besides them.
std::optional<Ghost> ghost_under_constraint(const LatticeSystem&);

/// "waves near theta = pi, z = -1 off the constraint's surface grow from rounding, and faster for a shorter time step".
std::string in_words_under_constraint(const Ghost&);

/// What to do about it: the end of a message.
inline constexpr const char* without_ghost_under_constraint =
    "use a stencil without them, such as lattice.stencil = rectangle";

}  // namespace delf
