// SPDX-License-Identifier: MIT
#pragma once
#include "lattice/stencil_shape.hpp"

namespace delf::shapes {

/// The triangle Δ = ((i, j), (i, j+1), (i+1, j+1)) of Marsden–Patrick–Shkoller, §5.1.
///
///     1 ── 2      time j+1
///     │  ╱
///     0           time j
///
inline constexpr Offsets<3> triangle{{{{0, 0}, {1, 0}, {1, 1}}}};

}  // namespace delf::shapes
