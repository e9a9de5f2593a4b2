// SPDX-License-Identifier: MIT
#pragma once
#include "lattice/space/mesh.hpp"

namespace delf {

/// The mesh with all sides halved: a segment is cut in two, a triangle or a quadrilateral in four. The points of the mesh
/// come first, in their order; those of a curved surface do not move onto it.
Mesh refined(const Mesh&);

}  // namespace delf
