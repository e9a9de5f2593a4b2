// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>

#include "jets/expressions/expression.hpp"
#include "jets/symmetry.hpp"

namespace delf {

/// The generator ξ of a symmetry as text, a change for each field, separated by commas: "-v, u" for rotations, "1" for
/// translations. Throws BadInput for `key` if it is not affine in the fields, or changes none.
LinearSymmetry generator_of(std::string_view text, const ExpressionNames&, const std::string& name,
                            const std::string& key);

/// Throws BadInput for `key`, with what is in the way, if the density changes along ξ by more than a divergence:
///
///     δℓ = Σ ∂ℓ/∂φ ξ + ∂ℓ/∂φ_t D_t ξ + ∂ℓ/∂φ_x D_x ξ + …  is zero, or solves every Euler–Lagrange equation,
///
/// or if a constraint changes where it holds; an empty one is none. Both are tried at random jets. True if δℓ is zero.
bool require_symmetry(const LinearSymmetry&, std::string_view density, std::string_view constraint,
                      const ExpressionNames&, const std::string& key);

}  // namespace delf
