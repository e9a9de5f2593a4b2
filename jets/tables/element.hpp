// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "lattice/stencil_shape.hpp"

namespace delf {

/// One quadrature point of an element, on the reference cell [0, 1]²:
///
///     φ = Σ_l phi[l] y_l        φ_t = Σ_l phi_t[l] y_l / h        φ_x = Σ_l phi_x[l] y_l / k
///
struct ElementPoint {
  double weight;
  double time, space;  ///< where it lies in the cell
  std::vector<double> phi, phi_t, phi_x;
};

/// Where a node of the unit cell lies in the cell, as fractions of h and k. Node 0 is the vertex (0, 0).
struct NodePosition {
  double time = 0, space = 0;
};

/// A linear jet map with nodes inside, made at run time for any degree: what JetTable is for the sites of a lattice.
/// The vertices of the pattern are sites {time, space, node}, anchored at the cell's vertex (0, 0).
struct Element {
  StencilPattern pattern;
  std::vector<ElementPoint> points;
  std::vector<NodePosition> nodes;  ///< of the unit cell
  /// The quadrature of the lower side, where a step starts: weights and φ, φ_x of the vertices there (time and node's
  /// time 0), in their order. φ_t has the weights of φ.
  std::vector<ElementPoint> lower_side = {};
};

}  // namespace delf
