// SPDX-License-Identifier: MIT
#pragma once
#include "jets/tables/jet_table.hpp"
#include "lattice/shapes/triangle.hpp"

namespace delf {

/// Marsden–Patrick–Shkoller, above (5.8): φ_t = (y₂ − y₁)/h, φ_x = (y₃ − y₂)/k, φ at the centroid.
///
/// The field equation of ℓ = ½φ_t² − ½φ_x² + cos φ − 1:
///
///     (phi(j+1,i) - 2*phi(j,i) + phi(j-1,i))/h^2 - (phi(j,i-1) - 2*phi(j,i) + phi(j,i+1))/k^2
///       + sin((phi(j+1,i) + phi(j+1,i+1) + phi(j,i))/3)/3 + sin((phi(j,i) + phi(j,i+1) + phi(j-1,i))/3)/3
///       + sin((phi(j,i-1) + phi(j,i) + phi(j-1,i-1))/3)/3 = 0
inline constexpr struct Triangle {
  static constexpr JetTable<3, 1> table{
      shapes::triangle, 1, {{{1, {1. / 3, 1. / 3, 1. / 3}, {-1, 1, 0}, {0, -1, 1}}}}};
} triangle;

/// TriangleCentre with the value of the first vertex in the nonlinear term (their footnote 3): an explicit scheme.
///
/// The field equation of ℓ = ½φ_t² − ½φ_x² + cos φ − 1:
///
///     (phi(j+1,i) - 2*phi(j,i) + phi(j-1,i))/h^2 - (phi(j,i-1) - 2*phi(j,i) + phi(j,i+1))/k^2 + sin(phi(j,i)) = 0
inline constexpr struct TriangleVertex {
  static constexpr JetTable<3, 1> table{shapes::triangle, 1, {{{1, {1, 0, 0}, {-1, 1, 0}, {0, -1, 1}}}}};
} triangle_vertex;

}  // namespace delf
