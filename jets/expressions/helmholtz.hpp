// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>

#include "jets/expressions/expression.hpp"

namespace delf {

/// Throws BadInput for `key` if no Lagrangian density has the field equations F_a = 0, one for each field, separated by
/// semicolons, each of them a sum or `sum = sum` of t, x, the fields and their derivatives up to second order. By
/// Helmholtz's conditions one exists exactly if the linearised equations are self-adjoint:
///
///     F_a′ = Σ c_ab δu_b + c_ab^μ ∂_μ δu_b + c_ab^μν ∂_μν δu_b            equals
///     its adjoint: Σ c_ba δu_b − ∂_μ(c_ba^μ δu_b) + ∂_μν(c_ba^μν δu_b)
///
/// (Olver, Applications of Lie Groups to Differential Equations, theorem 5.92). A friction is what fails most.
void require_lagrangian(std::string_view equations, const ExpressionNames&, const std::string& key);

/// Throws BadInput for `key` if the equations are not the field equations of the density, up to a constant factor each.
void require_field_equations(std::string_view equations, std::string_view density, const ExpressionNames&,
                             const std::string& key);

}  // namespace delf
