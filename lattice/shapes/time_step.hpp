// SPDX-License-Identifier: MIT
#pragma once
#include "lattice/stencil_shape.hpp"

namespace delf::shapes {

/// Two sites of a time lattice, Veselov's discrete mechanics:   0 ── 1    times j, j+1
inline constexpr Offsets<2> time_step{{{{0, 0}, {1, 0}}}};

}  // namespace delf::shapes
