// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "jets/expressions/euler_lagrange.hpp"
#include "jets/expressions/expression.hpp"
#include "jets/expressions/print.hpp"
#include "jets/tables/stencil_table.hpp"

namespace delf {

/// The field equations of a density as formulas, one line for each field: D_t ∂ℓ/∂φ_t + D_x ∂ℓ/∂φ_x − ∂ℓ/∂φ = 0.
std::vector<std::string> field_equations(const SymbolicDensity&, expressions::Notation);

/// The discrete field equations on a stencil at row j and site i, divided by −hk so that they tend to those above:
///
///     −(1/hk) Σ_{l: Δˡ = (j, i)} ∂L_Δ/∂yˡ = 0                                                              (5.2)
///
/// Brick walls have one for even and one for odd j + i.
std::vector<std::string> discrete_field_equations(const SymbolicDensity&, const StencilTable&, expressions::Notation);

/// A node of a graph of jets in plain notation. Throws TooLarge.
std::string formula_of(const expressions::Graph&, int node, const expressions::JetVariables&, const ExpressionNames&);

/// The density itself, with its sums and products in order; in plain notation as it was given.
std::string density_formula(const SymbolicDensity&, expressions::Notation);

}  // namespace delf
