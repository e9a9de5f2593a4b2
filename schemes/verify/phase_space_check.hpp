// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "jets/symmetry.hpp"
#include "schemes/verify/check.hpp"

namespace delf {

/// Fields and their momenta at one row, [i·C + c].
struct CanonicalRow {
  std::vector<double> q, p;
};

/// The quantities that a program's one-step map (q, p) ↦ (q₊, p₊) keeps, by any scheme: dq ∧ dp on the differences V, W
/// of nearby solutions, from row to row, and p·ξ(q) for symmetries.
///
///     ω(V, W) = Σ (V_q W_p − W_q V_p),          J = Σ_i p_i · ξ(q_i)
///
class PhaseSpaceCheck {
 public:
  /// `rounding`: of the values, relative to the largest; 0 for double precision.
  PhaseSpaceCheck(std::vector<LinearSymmetry>, double tolerance, double rounding);

  /// One row after the other, with the same row of pairs of nearby solutions: (A, B) at one size, further pairs at others.
  void at(std::int64_t row, const CanonicalRow&, const std::vector<CanonicalRow>& nearby);
  std::vector<Check> checks() const;
  /// ω could not be found: the differences are too large, or rounding.
  bool too_far() const { return tried_ && !symplectic_; }

 private:
  void look_at_form(std::int64_t row, const CanonicalRow&, const std::vector<CanonicalRow>& nearby);

  std::vector<LinearSymmetry> symmetries_;
  double tolerance_, rounding_;
  struct PairForm {
    Balance form;
    double size = 0, rounding = 0;  ///< ε, and what rounding makes of ω
  };
  std::vector<PairForm> before_;  ///< at the row before, of each pair
  std::vector<double> first_momentum_, largest_momentum_, worst_momentum_;
  std::vector<std::int64_t> worst_row_;
  std::int64_t rows_ = 0;
  bool tried_ = false;
  std::optional<Check> symplectic_;
};

}  // namespace delf
