// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

namespace delf {

/// Equation e, at any row, contains unknown u of the row that lies `time` later.
struct Occurrence {
  int equation = 0, unknown = 0;
  int time = 0;
  long long farness = 0;  ///< among equal matchings, the unknown of least farness is preferred
};

/// Pryce's Σ-method (BIT 41, 2001), with rows in the place of derivatives. σ(e, u) is the latest time at which equation
/// e contains unknown u. A perfect matching of largest Σσ says which equation is solved for which unknown, and offsets
///
///     d_u − c_e ≥ σ(e, u),   equal on the matching
///
/// at which rows: if slab J holds the unknowns u at the rows J + d_u and the equations e at the rows J + c_e, then the
/// equations of a slab contain unknowns of this slab and of earlier ones only.
struct StructuralAnalysis {
  std::vector<int> match;  ///< of each equation: the occurrence that it is solved for, or −1
  std::vector<int> c, d;
  std::vector<int> unmatched_equations, unmatched_unknowns;

  bool solvable() const { return unmatched_equations.empty(); }
};

/// The matching; then d is the least solution ≥ 0. Without a perfect matching, c and d are left empty.
StructuralAnalysis analyse(int size, const std::vector<Occurrence>& occurrences);

/// The least offsets d ≥ `least` for the same matching, and their c.
void raise_offsets(StructuralAnalysis&, const std::vector<Occurrence>& occurrences, std::vector<int> least);
/// The greatest offsets d ≤ `most`, and their c.
void lower_offsets(StructuralAnalysis&, const std::vector<Occurrence>& occurrences, std::vector<int> most);

}  // namespace delf
