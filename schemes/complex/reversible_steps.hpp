// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <vector>

#include "schemes/complex/space_rows.hpp"
#include "schemes/stepping/step_density.hpp"

namespace delf {

class AssembledEquations;

/// Steps that the field chooses and that a run back chooses again (StepDensity), h ≈ ε σ with
///
///     σ = 1/√(1 + s²⟨φ_t²⟩),    G = s²⟨φ_t·φ_tt⟩ / (1 + s²⟨φ_t²⟩),    ⟨f⟩ = Σ_i A_i f_i / Σ_i A_i:
///
/// rows as far apart as the path (t, sφ) of the field is long, in the mean over space. φ_t is that of the row, which the
/// discrete Legendre transform gives from the step below it: (φ_n − φ_{n−1})/h_{n−½} + ½h_{n−½} φ_tt. On a solution the step
/// above it gives the same, so G changes its sign with time.
class ReversibleSteps {
 public:
  /// ε and s. Throws BadInput where φ_tt does not follow from φ alone: T must be quadratic in φ_t.
  ReversibleSteps(const CellSpace&, double longest, double strength);
  ~ReversibleSteps();
  ReversibleSteps(const ReversibleSteps&) = delete;
  ReversibleSteps& operator=(const ReversibleSteps&) = delete;

  /// h_½, and h_{n+½} behind the newest row. Throw NotFinite if the steps are too long for the field.
  double first(std::span<const double> values, std::span<const double> rates);
  double next(const SpaceEvolution&);
  /// ε σ of the newest row: the plain step, which is not reversible.
  double plain(const SpaceEvolution&) const;
  /// Saves or restores the density of rows.
  void visit(SavedState& state) { density_.visit(state); }

 private:
  /// `share` of the step below the row is still missing in `rates`.
  RowDensity look(std::span<const double> values, std::vector<double> rates, double share) const;
  RowDensity look(const SpaceEvolution&) const;

  const CellSpace& space_;
  SpaceRows still_;  ///< one row, whose residual is A ∂V/∂φ
  std::unique_ptr<const AssembledEquations> force_;
  StepDensity density_;
  double strength_, area_ = 0;
  std::vector<double> inverse_mass_;  ///< (∂²T/∂φ_t∂φ_t)⁻¹, [a·d + b]
};

}  // namespace delf
