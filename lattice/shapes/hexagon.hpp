// SPDX-License-Identifier: MIT
#pragma once
#include "lattice/stencil_shape.hpp"

namespace delf::shapes {

/// The hexagon ⬡ of Marsden–Patrick–Shkoller, Fig. 5.4, as a brick: vertices a₀ a₁ a₂ b₀ b₁ b₂, bottom row first.
///
///     b₀ ─ b₁ ─ b₂      3 ── 4 ── 5      time j+1
///     │         │       │         │
///     a₀ ─ a₁ ─ a₂      0 ── 1 ── 2      time j,  i + j even
///
/// Bricks are laid half a brick apart, so that three meet in every site, and N must be even on a circle:
///
///     ──┬─────────┬─────────┬──
///       │         │         │
///     ──┴────┬────┴────┬────┴──
///            │         │
///     ──┬────┴────┬────┴────┬──
///
inline constexpr Offsets<6> hexagon{{{{0, 0}, {0, 1}, {0, 2}, {1, 0}, {1, 1}, {1, 2}}}, Placement::brick_wall};

}  // namespace delf::shapes
