// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <utility>

#include "lattice/space/mesh.hpp"

namespace delf {

/// Two cells that cover a part of space twice, the later one first: segments that lie on each other, triangles and
/// quadrilaterals of one plane whose insides meet. Surfaces that pass through each other are none. Of sound cells (see
/// find_fault()); they are found by a tree of boxes.
std::optional<std::pair<int, int>> overlapping_cells(const Mesh&);

}  // namespace delf
