// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "lattice/space/mesh.hpp"

namespace delf {

/// The shape of a mesh apart from its lengths: a sphere has χ = 2 and no boundary, a disc 1 and one curve, a torus 0 and none,
/// and a disc that is cut along a seam whose points are there twice is two discs.
struct MeshTopology {
  int pieces = 0;      ///< parts that are connected by their points
  int euler = 0;       ///< χ = points − sides + cells
  int boundaries = 0;  ///< curves of the boundary; of curves their ends
};
MeshTopology topology(const Mesh&);

/// "Euler characteristic 0, 2 boundary curves", and how many pieces if there are several.
std::string in_words(const MeshTopology&, int dimension);

}  // namespace delf
