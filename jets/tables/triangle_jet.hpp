// SPDX-License-Identifier: MIT
#pragma once
#include "jets/tables/jet_table.hpp"
#include "lattice/shapes/triangle.hpp"

namespace delf {

/// Marsden–Patrick–Shkoller, above (5.8): φ_t = (y₂ − y₁)/h, φ_x = (y₃ − y₂)/k, φ at the centroid.
inline constexpr struct Triangle {
  static constexpr JetTable<3, 1> table{
      shapes::triangle, 1, {{{1, {1. / 3, 1. / 3, 1. / 3}, {-1, 1, 0}, {0, -1, 1}}}}};
} triangle;

/// The same with the value of the first vertex in the nonlinear term (their footnote 3): an explicit scheme.
inline constexpr struct TriangleVertex {
  static constexpr JetTable<3, 1> table{shapes::triangle, 1, {{{1, {1, 0, 0}, {-1, 1, 0}, {0, -1, 1}}}}};
} triangle_vertex;

}  // namespace delf
