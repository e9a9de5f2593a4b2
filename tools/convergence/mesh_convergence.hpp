// SPDX-License-Identifier: MIT
#pragma once
#include "tools/compare/convergence_table.hpp"
#include "tools/complex/complex_scene.hpp"

namespace delf {

/// Levels 0, 1, …: the scene on its mesh with sides and steps at 1, ½, ¼, … (icosahedra of the next levels; any other mesh
/// is cut, see refined()). Errors against the exact solution, or differences at the points of the coarser mesh, in the
/// maximum norm and √(Σ A_i e_i²), which the order is of. Throws BadScene for a finite complex, which nothing refines.
ConvergenceTable converge(const ComplexScene&, int levels);

}  // namespace delf
