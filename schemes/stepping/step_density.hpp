// SPDX-License-Identifier: MIT
#pragma once

namespace delf {

class SavedState;

/// The density of steps at a row: σ, which steps shall be in proportion to, and how it changes.
struct RowDensity {
  double density;  ///< 1/σ
  double slope;    ///< G = −d(log σ)/dt along the motion
};

/// Steps that the motion chooses and that a run back chooses again: the density ρ of rows in time is a variable of its own,
/// carried along by an explicit and symmetric step,
///
///     ρ_{n+½} = ρ_{n−½} + ε G_n,    h_{n+½} = ε/ρ_{n+½},    G = −d(log σ)/dt,
///
/// the integrating controller of Hairer, Söderlind, SIAM J. Sci. Comput. 26, 1838 (2005), for steps h ≈ ε σ. On a solution
/// G of a row must be the same from the step below it and from the step above it, with the sign of time. The steps are no
/// function of the row alone, and the map from rows to rows is reversible, not symplectic.
class StepDensity {
 public:
  /// ε
  explicit StepDensity(double longest) : longest_(longest) {}

  /// h_½, from ρ_½ = ρ_0 + ½ε G_0 and ρ_0 = 1/σ_0. These throw NotFinite if ρ is not positive: the steps are too long.
  double first(const RowDensity&);
  /// h_{n+½} behind row n.
  double next(const RowDensity&);
  /// ε σ: the plain step, which is not reversible.
  double plain(const RowDensity& row) const { return longest_ / row.density; }

  /// ρ of the last step. A run back begins with that of the step that it repeats.
  double value() const { return density_; }
  double go_on_from(double density);
  /// Saves or restores the density of rows.
  void visit(SavedState&);

 private:
  double step() const;

  double longest_, density_ = 1;
};

}  // namespace delf
