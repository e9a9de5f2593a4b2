// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "schemes/complex/space_rows.hpp"

namespace delf {

/// Steps that the field chooses and that a run back chooses again: the density ρ of rows in time is a variable of its own,
/// carried along by an explicit and symmetric step,
///
///     ρ_{n+½} = ρ_{n−½} + ε G_n,    h_{n+½} = ε/ρ_{n+½},    G = −d(log σ)/dt,
///
/// the integrating controller of Hairer, Söderlind, SIAM J. Sci. Comput. 26, 1838 (2005), for steps h ≈ ε σ with
///
///     σ = 1/√(1 + s²⟨φ_t²⟩),    G = s²⟨φ_t·φ_tt⟩ / (1 + s²⟨φ_t²⟩),    ⟨f⟩ = Σ_i A_i f_i / Σ_i A_i:
///
/// rows as far apart as the path (t, sφ) of the field is long, in the mean over space. φ_t is that of the row, which the
/// discrete Legendre transform gives from the step below it: (φ_n − φ_{n−1})/h_{n−½} + ½h_{n−½} φ_tt. On a solution the step
/// above it gives the same, so G changes its sign with time. The steps are no function of the row alone, and the map from
/// rows to rows is reversible, not symplectic.
class ReversibleSteps {
 public:
  /// ε and s. Throws BadInput where φ_tt does not follow from φ alone: T must be quadratic in φ_t.
  ReversibleSteps(const CellSpace&, double longest, double strength);

  /// h_½, from ρ_½ = ρ_0 + ½ε G_0 and ρ_0 = 1/σ_0.
  double first(std::span<const double> values, std::span<const double> rates);
  /// h_{n+½} behind the newest row. Throws NotFinite if ρ is not positive: the steps are too long for the field.
  double next(const SpaceEvolution&);
  /// ε σ of the newest row: the plain step, which is not reversible.
  double plain(const SpaceEvolution&);
  /// Saves or restores the density of rows.
  void visit(SavedState&);

 private:
  struct Row {
    double density, slope;  ///< 1/σ and G
  };
  /// `share` of the step below the row is still missing in `rates`.
  Row look(std::span<const double> values, std::vector<double> rates, double share);
  Row look(const SpaceEvolution&);
  double step() const;

  const CellSpace& space_;
  SpaceRows still_;  ///< one row, whose residual is A ∂V/∂φ
  double longest_, strength_, density_ = 1, area_ = 0;
  std::vector<double> inverse_mass_;  ///< (∂²T/∂φ_t∂φ_t)⁻¹, [a·d + b]
};

}  // namespace delf
