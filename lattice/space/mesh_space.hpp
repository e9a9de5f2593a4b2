// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "lattice/space/mesh.hpp"

namespace delf {

/// A mesh as the space of a lattice: its points are the sites of a row.
struct MeshSpace {
  Mesh mesh;
  std::vector<char> fixed;  ///< [site]: the site keeps its value, and has no equation
};

}  // namespace delf
