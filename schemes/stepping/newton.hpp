// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "lattice/plan/solve_plan.hpp"
#include "schemes/system/assembly.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// The number of iterations after which more of them find no root either.
inline constexpr int enough_iterations = 12;
/// The remedy for a user who has allowed so many.
std::string remedy_for(int max_iterations);

struct NewtonResult {
  bool converged = false;
  int iterations = 0;
  double reached = 0;       ///< the part of the step that the root was followed to
  std::vector<double> row;  ///< the unknown row, row[i·d + a]; of follow_slab() the unknowns of the slab
};

/// Solves the slab whose unknown row follows `past` (its last row is the newest known) where the equations may have
/// several roots. The one is wanted that h → 0 leads to: it is followed from a small h by full Newton steps, each
/// stride taken once and in two halves that must agree, and given up where the Jacobian's determinant changes sign,
/// because there the path turns back. Never another root in silence, unless it is not to be `followed`: by Newton's
/// method from y_n + v_n at once, which may arrive at any root.
NewtonResult solve_slab(const LatticeSystem&, const SolvePlan&, const Window& past, double tolerance,
                        int max_iterations, bool followed = true);

/// The rows of a section, of which slab J is to be found; multipliers of slab J hold a prediction.
struct SlabPast {
  const SectionRing& rows;
  std::int64_t J, slabs;  ///< `slabs` before it are known, with their inner nodes and multipliers
  Assembly::Parts parts;  ///< of the slab
  const std::vector<double>& known;  ///< the part of the equations that no unknown changes: momenta of the newest row
  /// The momenta of row 0, where slab 0 is solved from them: in place of `known`.
  const std::vector<double>* momenta = nullptr;
};
/// Follows a slab of any kind: a small step begins at the newest row and its momenta; stencils below keep their step.
NewtonResult follow_slab(const LatticeSystem&, const SlabPast&, double tolerance, int max_iterations);
/// True if the determinant has not the sign at this root that it has for a small step: between them two roots meet.
bool turns_back(const LatticeSystem&, const SlabPast&, const std::vector<double>& unknowns, double tolerance);

/// Row 1 from row 0 and φ_t: the equation at row 0 with y₋₁ = y₁ − 2hφ_t. By Newton from y₀ + hφ_t at once; if that does
/// not converge, or if it is to be `followed`, from a small h as above. Throws NoConvergence.
NewtonResult solve_centred_start(const LatticeSystem&, const SolvePlan&, const Window& row0,
                                 const std::vector<double>& velocity, bool followed, double tolerance,
                                 int max_iterations);

}  // namespace delf
