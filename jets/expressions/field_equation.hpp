// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "jets/batch_density.hpp"

namespace delf {

/// The field equations of a density at one point of a given field, to check that it solves them:
///
///     E_a = D_t ∂ℓ/∂φ_t + D_x ∂ℓ/∂φ_x − ∂ℓ/∂φ − D_t² ∂ℓ/∂φ_tt − …
///
/// Under a constraint G = 0 of a text E is what no multiplier balances, E − λ ∂G/∂φ, and G is one equation more.
class FieldEquations {
 public:
  /// Nothing for a compiled density of second derivatives, and for a text whose equations are too large.
  static std::optional<FieldEquations> of(const BatchDensity&);

  /// The order of the highest derivative that the equations read: 2, or 4 for densities of second order.
  int order() const;

  struct Value {
    double sum = 0, absolute = 0;  ///< of the terms
  };
  /// `jet` has ∂ᵐ⁺ⁿφ_a/∂tᵐ∂xⁿ at (o (o + 1)/2 + n) d + a with o = m + n, from φ to all of that order. The density is to live
  /// as long.
  std::vector<Value> operator()(std::span<const double> jet, double t, double x) const;
  /// Bounds the change of the sums when each number of the jet is rounded by the relative amount `rounding`.
  std::vector<double> rounding(std::span<const double> jet, double t, double x, double rounding) const;

  class Form;

 private:
  explicit FieldEquations(std::shared_ptr<const Form> form) : form_(std::move(form)) {}
  std::shared_ptr<const Form> form_;
};

/// Derivatives in a jet of one field up to an order: φ, φ_t, φ_x, φ_tt, φ_tx, φ_xx, …
constexpr int derivatives_up_to(int order) { return (order + 1) * (order + 2) / 2; }

}  // namespace delf
