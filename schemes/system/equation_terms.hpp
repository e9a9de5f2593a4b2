// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "lattice/plan/solve_plan.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// The factor of a term of the assembled equation. Rows count from the newest known row n; y_{n+1} = y_n + v_n + w.
enum class Source {
  difference,  ///< y_n at the shifted site minus y_n at the equation's own (its own component)
  value,       ///< y_n
  increment,   ///< v_{n−age}
  unknown,     ///< w
  output       ///< out_c of the stencils anchored at row n + age
};

struct Term {
  Source source;
  int age = 0;        ///< increment: v_{n−age}; output: anchors' row n + age
  int component = 0;  ///< of y, v, w
  int family = 0, output = 0;
  int shift = 0;  ///< space offset from the equation's site
  double coefficient = 0;
  double alternating = 0;  ///< brick walls: added where row + site is even, subtracted where it is odd
};

/// The equation of one component, as a sum over rows: E = constant + Σ coefficient · source.
struct EquationTerms {
  double constant = 0, constant_alternating = 0;
  std::vector<Term> terms;
  int shift = 1;  ///< the equation's row is n + 1 − shift
};

/// Coefficients at the unknown row of the matrix that a step factors: at (site offset, component).
struct UnknownEntry {
  int space, component;
  double coefficient, alternating;
};

/// An equation that differs from the bulk's: near a wall. At a fixed wall `fixed` is set and there are no terms.
struct SiteEquation {
  int site = 0, component = 0;
  bool fixed = false;
  EquationTerms equation;
  std::vector<UnknownEntry> unknowns;
};

/// The system's equations in the form that is stepped: alike for all sites but those near walls.
struct SteppedEquations {
  std::vector<EquationTerms> bulk;                  ///< for each component
  std::vector<std::vector<UnknownEntry>> unknowns;  ///< of the bulk, for each component
  std::vector<SiteEquation> exceptional;
};

/// Whole rows can be stepped: every unknown of a slab lies in its row, and every family reads d fields at each of its
/// vertices and is a constant part and source terms. What cannot is stepped slab by slab.
bool goes_by_rows(const LatticeSystem&, const SolvePlan&);

SteppedEquations assemble(const LatticeSystem&, const SolvePlan&);

}  // namespace delf
