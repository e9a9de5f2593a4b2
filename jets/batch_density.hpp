// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "jets/numbers/structure.hpp"
#include "jets/symmetry.hpp"

namespace delf {

class ForceSquared;
class SymbolicDensity;
class ValueDerivatives;

/// n jets as separate arrays, aligned to packs: slots[s·d + a][i] is component a of slot s (φ, φ_t, φ_x, and φ_tt,
/// φ_tx, φ_xx for densities of second order) of jet i.
struct JetBatch {
  int count;  ///< n, a multiple of `lanes`
  const double* const* slots;
  double t = 0;               ///< of all of them
  const double* x = nullptr;  ///< [n], if the density is placed
};

/// A Lagrangian density ℓ, evaluated for many jets at once. All that steps, checks and stability theory know of a theory;
/// BatchOf wraps a functor.
class BatchDensity {
 public:
  virtual ~BatchDensity() = default;

  int components() const { return components_; }
  int slots() const { return slots_; }                 ///< 3, or 6 with second derivatives
  int variables() const { return slots_ * components_; }
  bool is_placed() const { return placed_; }
  const std::vector<LinearSymmetry>& symmetries() const { return symmetries_; }
  Nonlinearity nonlinearity() const { return structure_.nonlinearity; }
  /// ℓ may depend on variable a.
  bool depends_on(int a) const { return bit(structure_.of_density.depends, a); }
  /// ∂²ℓ/∂a∂b is proved to be the same at every jet, everywhere.
  bool is_constant(int a, int b) const {
    return !bit(structure_.of_density.varying[a], b);
  }
  /// ∂²ℓ/∂a∂b is proved to be zero.
  bool is_zero(int a, int b) const {
    return !bit(structure_.of_density.nonzero[a], b);
  }
  /// A reflection of jets is proved to leave ℓ as it is.
  bool is_even(Reflection r) const { return bit(structure_.of_density.even, static_cast<int>(r)); }
  /// The Hessian with all entries zero that are not proved constant, [a·variables + b].
  const std::vector<double>& constant_hessian() const { return constant_hessian_; }
  /// ∂ℓ/∂(variable) less what the constant Hessian makes of it, where that is a number: at the jet 0.
  const std::vector<double>& constant_gradient() const { return constant_gradient_; }

  virtual void value(const JetBatch&, double* l) const = 0;
  /// g[a][i] = ∂ℓ/∂(variable a) at jet i, and ℓ itself if `l` is given.
  virtual void gradient(const JetBatch&, double* const* g, double* l = nullptr) const = 0;
  /// H[a·variables + b][i]
  virtual void hessian(const JetBatch&, double* const* H) const = 0;
  /// g[a][i] = ∂ℓ/∂φᵃ at (φ, 0, …): the source term where only that is nonlinear. Slots hold φ alone.
  virtual void slope(const JetBatch& phi, double* const* g) const = 0;
  /// d[a·d + b][i] = ∂²ℓ/∂φᵃ∂φᵇ at (φ, 0, …).
  virtual void curvature(const JetBatch& phi, double* const* d) const = 0;
  /// ∂ℓ/∂t and ∂ℓ/∂x at given (t, x), for densities that depend on them: l_t[i], l_x[i].
  virtual void place_gradient(const JetBatch&, double* l_t, double* l_x) const = 0;

  /// The formula that the density was made of; null: it was compiled.
  virtual const SymbolicDensity* formula() const { return nullptr; }
  /// The density as the square of another one's force; null: it is none.
  virtual const ForceSquared* squared_force() const { return nullptr; }
  /// Derivatives in φ that force gradients take; null: they are not known.
  virtual const ValueDerivatives* value_derivatives() const { return nullptr; }

  /// True if the density declares T difference_quotient(const T& a, const T& b): (N(a) − N(b))/(a − b) of its potential
  /// N(φ) = ℓ(φ, 0, 0), also where a = b; of several components an array. q[c][i], from the d components of a and those
  /// of b in `slots`; and its derivatives d[c·2d + j][i].
  bool has_difference_quotient() const { return has_difference_quotient_; }
  virtual void difference_quotient(const JetBatch& /*ab*/, double* const* /*q*/) const {}
  virtual void differentiate_quotient(const JetBatch& /*ab*/, double* const* /*d*/) const {}

 protected:
  /// To be called by constructors of what is ready to be evaluated.
  void find_constants();

  int components_ = 1, slots_ = 3;
  bool placed_ = false, has_difference_quotient_ = false;
  DensityStructure structure_;
  std::vector<LinearSymmetry> symmetries_;

 private:
  static bool bit(std::uint64_t bits, int a) { return (bits >> a & 1) != 0; }
  std::vector<double> constant_hessian_, constant_gradient_;
};

}  // namespace delf
