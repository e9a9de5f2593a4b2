// SPDX-License-Identifier: MIT
#pragma once
#include "jets/expressions/modified/jet_algebra.hpp"
#include "jets/expressions/modified/modified_jets.hpp"

namespace delf::expressions {

/// The sum without terms that are divergences, D_x of anything and D_t of what has no φ_t, in a form that is as short as
/// integration by parts makes it:
///
///     r uⁿ_p ∂ₓu_p  →  −uⁿ⁺¹_p D_x r/(n + 1)         u_p the (p − 1)-th derivative, r of lower derivatives
///     r φⁿ φ_t      →  −φⁿ⁺¹ D_t r/(n + 1)           at equal derivatives in x, r without φ_t
///
/// The highest derivative of every term is then at least squared, or beside another of its own order.
JetSum without_divergences(JetAlgebra&, ModifiedJets&, JetSum);

}  // namespace delf::expressions
