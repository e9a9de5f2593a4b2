// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "lattice/space/mesh.hpp"

namespace delf {

/// A quadrature point of a cell: its share of the measure, N_l, and ∂_aN_l in an orthonormal frame of the tangent space.
struct CellPoint {
  double weight;
  std::vector<double> value;
  std::vector<std::vector<double>> slopes;  ///< [a][l]
};
/// The points of linear (P1) and bilinear (Q1) cells: one in a segment or a triangle, Gauss's four in a quadrilateral.
std::vector<CellPoint> cell_points(const Mesh&, int cell);

/// ∫ N of each corner over the cell: the shares of its measure.
std::vector<double> corner_shares(const Mesh&, int cell);
/// A_i = Σ_cells ∫ N_i of each point: the lumped masses.
std::vector<double> lumped_masses(const Mesh&);

}  // namespace delf
