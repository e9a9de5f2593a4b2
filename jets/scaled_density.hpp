// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <memory>

#include "jets/batch_density.hpp"

namespace delf {

/// A density in units of other rows: fields are `scale` s times those of ℓ, and space is `speed` c times longer, so that waves
/// of speed 1 have the speed c,
///
///     ℓ̃(φ, φ_t, φ_x) = s² ℓ(φ/s, φ_t/s, c φ_x/s).
///
/// Its field equation is φ_tt = c²φ_xx + s N′(φ/s) where that of ℓ is φ_tt = φ_xx + N′(φ).
class ScaledDensity final : public BatchDensity {
 public:
  /// Throws BadInput, key theory.speed, for a density that depends on t or x.
  ScaledDensity(std::shared_ptr<const BatchDensity> of, double speed, double scale);

  void value(const JetBatch&, double* l) const override;
  void gradient(const JetBatch&, double* const* g, double* l = nullptr) const override;
  void hessian(const JetBatch&, double* const* H) const override;
  void slope(const JetBatch& phi, double* const* g) const override;
  void curvature(const JetBatch& phi, double* const* d) const override;
  void place_gradient(const JetBatch&, double* l_t, double* l_x) const override;
  void difference_quotient(const JetBatch& ab, double* const* q) const override;
  void differentiate_quotient(const JetBatch& ab, double* const* d) const override;

 private:
  struct Inner;
  double factor(int variable) const { return factors_[variable / components_]; }

  std::shared_ptr<const BatchDensity> of_;
  double scale_;
  std::array<double, 6> factors_;  ///< of the slots φ, φ_t, φ_x, φ_tt, φ_tx, φ_xx
};

}  // namespace delf
