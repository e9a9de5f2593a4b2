// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "jets/expressions/graph.hpp"
#include "jets/expressions/parse.hpp"

namespace delf::expressions {

/// Variables of a graph in which a density is differentiated as a function of t and x: d fields with their derivatives up to
/// fourth order, then x, t, and the parameters, which keep their names. Derivatives up to second order have the numbers of
/// jet slots.
struct JetVariables {
  static constexpr int highest_order = 4, slots = 15;

  explicit JetVariables(const ExpressionNames&);

  int d, parameters;
  int x() const { return slots * d; }
  int t() const { return slots * d + 1; }
  int parameter(int p) const { return slots * d + 2 + p; }
  int multiplier(int m) const { return parameter(parameters + m); }  ///< of constraint m; no text names it
  /// ∂ⁿ/∂tᵐ∂xⁿ⁻ᵐ of field a, by the number of derivatives in t and in x.
  int derivative(int a, int in_t, int in_x) const {
    const int order = in_t + in_x;
    return (order * (order + 1) / 2 + in_x) * d + a;
  }
  struct Derivative {
    int field, in_t, in_x;
  };
  Derivative of(int variable) const;
  bool is_derivative(int variable) const { return variable < slots * d; }

  /// The names that a text may use: fields, their derivatives up to second order, x, t, and parameters.
  Names names;
};

/// d/dt or d/dx of a function of t, x and the fields. Throws std::logic_error for derivatives beyond the fourth order.
int total_derivative(Graph&, int root, const JetVariables&, bool in_t);

/// The terms of D_t ∂ℓ/∂φ_t + D_x ∂ℓ/∂φ_x − ∂ℓ/∂φ − D_t² ∂ℓ/∂φ_tt − … of field a: the field equation is that their sum is 0.
std::vector<int> euler_lagrange(Graph&, int l, int a, const JetVariables&);

}  // namespace delf::expressions
