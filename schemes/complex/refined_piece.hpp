// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/complex/stencil_list.hpp"

namespace delf {

/// The piece 0 ≤ x ≤ length, 0 ≤ t ≤ duration of spacetime in cells × steps rectangles, of which those of the middle third
/// are cut in four. Beside them a rectangle has a fifth site, and is three triangles:
///
///     ├───────┬───┬───┬───────┤
///     │       ├───┼───┤       │        each column of sites has time steps of its own: h/2 in the middle
///     ├───────┼───┼───┼───────┤        and at its edges, h elsewhere
///
/// The walls are given, and of each other column the first two sites. `cells` is a multiple of 3.
StencilList refined_piece(double length, double duration, int cells, int steps);

}  // namespace delf
