// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "schemes/complex/complex_system.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// The slabs between consecutive rows of a mesh as a complex, whose checks they then have: a site of the complex is a point
/// of the mesh in a row, or a node of time inside a slab there, with the d fields; or each of their values and of the multipliers,
/// where there are any. Equations hold at the nodes of all slabs
/// and at the rows but the first and the last.
struct SlabComplex {
  ComplexSystem system;
  std::vector<double> values;  ///< [site·d + a]
};
/// Throws BadInput "scheme.method" for a method without an action, such as Radau IIA.
SlabComplex slab_complex(const LatticeSystem&, const Window&);

}  // namespace delf
