// SPDX-License-Identifier: MIT
#pragma once
#include "lattice/stencil_shape.hpp"

namespace delf::shapes {

/// The nine-tuple ⊞ around its centre: second-order in space and time (J²Y). Row by row in time, then along space.
///
///     6 ── 7 ── 8      time j+1
///     │    │    │
///     3 ── 4 ── 5      time j            centre: vertex 4
///     │    │    │
///     0 ── 1 ── 2      time j−1
///
inline constexpr Offsets<9> nine_tuple{
    {{{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}, {0, 0}, {0, 1}, {1, -1}, {1, 0}, {1, 1}}}};

}  // namespace delf::shapes
