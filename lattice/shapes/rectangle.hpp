// SPDX-License-Identifier: MIT
#pragma once
#include "lattice/stencil_shape.hpp"

namespace delf::shapes {

/// The rectangle □ = ((i, j), (i, j+1), (i+1, j+1), (i+1, j)) of Marsden–Patrick–Shkoller, §5.1.
///
///     1 ── 2      time j+1
///     │    │
///     0 ── 3      time j
///
inline constexpr Offsets<4> rectangle{{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}};

}  // namespace delf::shapes
