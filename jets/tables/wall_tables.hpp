// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "jets/tables/stencil_table.hpp"

namespace delf {

/// The terms that the action of a table needs at natural walls: at most one for the left wall and one for the right,
/// each on the wall's own sites (0, 0) and (1, 0), with the placement of that wall.
///
/// The site at a wall stands for half a cell, and its field equation is of second order only if half a cell's kinetic
/// term and half a cell's potential term stand there. The stencils inside the lattice give the wall the shares m and p
/// of a cell, the column sums of the weights of φ_t and of φ:
///
///     m = Σ_q w_q Σ_{l in the column} (M_q)_φt,l · (time offset of l),    p = Σ_q w_q Σ_{l in the column} (M_q)_φ,l
///
/// What is missing, or too much, stands in the term:
///
///     L_wall = hk {(½ − m) [ℓ(y₁, (y₂ − y₁)/h, 0) − ℓ(y₁, 0, 0)] + (½ − p) ℓ(y₁, 0, 0)}
///
/// with φ_x = 0, the natural condition. Triangles: m = 1 and 0, so that one wall has twice its inertia and the other
/// none. Rectangles, whose two columns are alike, need no term. Stencils wider than a cell and elements with nodes
/// inside their cells are given none.
std::vector<StencilTable> wall_tables(const StencilTable&);

}  // namespace delf
