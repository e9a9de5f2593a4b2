// SPDX-License-Identifier: MIT
#pragma once
#include <memory>

#include "jets/batch_density.hpp"

namespace delf {

/// A density on sites that move, Tyranowski–Desbrun (5), (6): the position X of the sites is one field more, number d, over
/// the same computational space, and φ(t, x) stands for the field at X(t, x),
///
///     ℓ̃ = ℓ(φ, φ_t − φ_x X_t/X_x, φ_x/X_x) X_x
///
/// It is an ordinary density of d + 1 fields, made of any ℓ by the chain rule from its gradient and its Hessian. Of an ℓ
/// that is nonlinear in φ alone it may be one of two parts, ℓ̃ = quadratic + potential, which want different quadratures:
///
///     potential = N(φ) X_x,    N(φ) = ℓ(φ, 0, 0);    quadratic: what ℓ has besides N, by its constant Hessian
class Reparametrised final : public BatchDensity {
 public:
  enum class Part { whole, quadratic, potential };
  /// ℓ is N(φ) and a quadratic form of the jet, so that it has the two parts.
  static bool has_parts(const BatchDensity& of) { return of.nonlinearity() != Nonlinearity::all; }

  /// Throws BadInput, about theory.name: a density that depends on t or x, or on second derivatives.
  Reparametrised(std::shared_ptr<const BatchDensity> of, Part);

  void value(const JetBatch&, double* l) const override;
  void gradient(const JetBatch&, double* const* g, double* l = nullptr) const override;
  void hessian(const JetBatch&, double* const* H) const override;
  // Asked of densities that are nonlinear in φ alone, and of those that depend on the place: this is neither.
  void slope(const JetBatch& phi, double* const* g) const override;
  void curvature(const JetBatch& phi, double* const* c) const override;
  void place_gradient(const JetBatch&, double* l_t, double* l_x) const override;

 private:
  struct Inner;

  std::shared_ptr<const BatchDensity> of_;
  Part part_;
  int inner_;                      ///< variables of ℓ
  std::vector<double> form_, g0_;  ///< quadratic: its Hessian and its gradient at zero
};

}  // namespace delf
