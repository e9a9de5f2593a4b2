// SPDX-License-Identifier: MIT
#pragma once
#include "lattice/stencil_shape.hpp"

namespace delf::shapes {

/// The six-tuple ◫ over the rows j and j+1: second-order in space, first-order in time (J²₀Y).
///
///     5 ── 4 ── 3      time j+1          vertices in the order of Tyranowski–Desbrun (113)
///     │    │    │
///     0 ── 1 ── 2      time j            centre: vertex 1
///
inline constexpr Offsets<6> six_tuple{{{{0, -1}, {0, 0}, {0, 1}, {1, 1}, {1, 0}, {1, -1}}}};

}  // namespace delf::shapes
