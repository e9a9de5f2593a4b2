// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "jets/tables/stencil_table.hpp"
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
/// The gradient in V as points of a table of one coordinate: one for each component of ∇φ. Where φ and ∇φ are `coupled` they have
/// φ too, and V without the gradient is taken off. Every corner has an entry, so that all tables have one form.
std::vector<TablePoint> gradient_table(const Mesh&, int cell, bool coupled);
/// V of a cell: its gradient, and φ at each corner with its share.
std::vector<TablePoint> cell_table(const Mesh&, int cell, bool coupled);

/// A_i = Σ_cells ∫ N_i of each point: the lumped masses.
std::vector<double> lumped_masses(const Mesh&);

}  // namespace delf
