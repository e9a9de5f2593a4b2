// SPDX-License-Identifier: MIT
#pragma once
#include <memory>

#include "jets/batch_density.hpp"
#include "jets/value_derivatives.hpp"

namespace delf {

/// The square of the force of a density ℓ that is nonlinear in φ alone, itself a density, on jets with φ_xx:
///
///     ℓ̃ = κ Σ_a F_a²,    F_a = ∂ℓ/∂φᵃ − Σ_b ∂²ℓ/∂φ_xᵃ∂φ_xᵇ φ_xxᵇ
///
/// Its kick is the force gradient: ∂ℓ̃/∂φᵃ = 2κ Σ_c F_c ∂²ℓ/∂φᶜ∂φᵃ, all by derivatives of ℓ.
class ForceSquared final : public BatchDensity {
 public:
  /// Throws BadInput, about theory.name, for a density that has no such force: nonlinear in derivatives of φ, or with products
  /// of φ and its derivatives.
  ForceSquared(std::shared_ptr<const BatchDensity> of, double scale);

  void value(const JetBatch&, double* l) const override;
  void gradient(const JetBatch&, double* const* g, double* l = nullptr) const override;
  void hessian(const JetBatch&, double* const* H) const override;
  void slope(const JetBatch& phi, double* const* g) const override;
  void curvature(const JetBatch& phi, double* const* c) const override;
  void place_gradient(const JetBatch&, double* l_t, double* l_x) const override;

  const ForceSquared* squared_force() const override { return this; }
  /// gradient() without the rows that are zero: g[a] by φᵃ, g[d + a] by φ_xxᵃ, from φ in slots[a] and φ_xx in second[a]; and
  /// g[2d + a] = ∂ℓ/∂φᵃ, which it takes anyway.
  const BatchDensity& of() const { return *of_; }
  void gradient_at_rest(const JetBatch& phi, const double* const* second, double* const* g) const;

 private:
  double stiffness(int a, int b) const { return stiffness_[a * components_ + b]; }

  std::shared_ptr<const BatchDensity> of_;
  const ValueDerivatives* derivatives_;
  std::vector<double> stiffness_;  ///< −∂²ℓ/∂φ_xᵃ∂φ_xᵇ
  double scale_;
};

}  // namespace delf
