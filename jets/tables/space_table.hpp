// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "jets/tables/line_basis.hpp"
#include "jets/tables/line_rule.hpp"
#include "jets/tables/stencil_table.hpp"

namespace delf {

// Space alone, as tables of one row: φ and φ_x at the points of one cell, and no φ_t. A time table × one of them is a
// scheme (jets/tables/table_product.hpp).

/// One point, without neighbours: mechanics.
StencilTable point_space();

/// A finite element with the nodes of `basis`, which has both end nodes: node 0 is the vertex, the last one that of the
/// next cell, the others lie inside.
StencilTable element_space(const LineBasis& basis, const LineRule& rule);
/// Degree p on Lobatto nodes, integrated there: explicit, its mass at a node is that node's own. The least, p = 1, is
/// the lumped linear element, Σ ½[ℓ(y_i, D) + ℓ(y_{i+1}, D)] with D = (y_{i+1} − y_i)/k. Throws BadInput for p outside
/// 1 … 12.
StencilTable spectral_space(int degree);
/// The linear element, integrated by Gauss's rule of two points: its mass couples neighbours, (1, 4, 1)/6 for ½φ_t².
StencilTable linear_space();

/// Pairs of sites as far apart as this make space of order 20.
inline constexpr int widest_pair = 10;
/// The weights of the pairs {i, i + m}, m = 1 … p, in the action of order 2p:
///
///     m² β_m = 2 (−1)^{m+1} p!² / ((p − m)! (p + m)!),    Σ_m m² β_m = 1
///
std::vector<double> pair_weights(int p);
/// Pairs of sites of the weights m² β_m, Σ_m m² β_m ½[ℓ(y_i, D_m) + ℓ(y_{i+m}, D_m)] with D_m = (y_{i+m} − y_i)/(mk): any density,
/// and of order 2p with pair_weights(p). Wider than a cell for p > 1, and then for circles.
StencilTable pair_space(const std::vector<double>& weights);

}  // namespace delf
