// SPDX-License-Identifier: MIT
#pragma once
#include <memory>

#include "jets/tables/stencil_table.hpp"
#include "lattice/lattice.hpp"
#include "lattice/plan/solve_plan.hpp"
#include "schemes/complex/complex_system.hpp"

namespace delf {

/// Some rows of a regular lattice as a complex. Its plan says how many rows are data, and at which rows equations hold.
struct LatticeComplex {
  LatticeComplex(const Lattice&, const SolvePlan&, const StencilTable&, std::shared_ptr<const BatchDensity>,
                 double time_step, int rows);

  int site(int row, int space) const { return (row + outer) * sites + space; }

  int sites;  ///< in a row
  int outer;  ///< rows before row 0, and behind the last, that stencils have and equations do not read
  ComplexSystem system;
};

}  // namespace delf
