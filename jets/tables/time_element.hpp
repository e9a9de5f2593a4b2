// SPDX-License-Identifier: MIT
#pragma once
#include "jets/tables/line_basis.hpp"
#include "jets/tables/line_rule.hpp"
#include "jets/tables/stencil_table.hpp"

namespace delf {

/// The link between pieces of a trajectory: nodes that neighbours share, or multipliers at the ends of broken elements.
enum class Continuity { shared, multipliers };

/// An element of time on one site: q = Σ_j φ_j(t/h) x_j, with a quadrature rule on every span between the basis's knots.
///
///     q_n   x⁰ x¹ … x^{S−1}           q_{n+1}      multipliers: node 0 of the unit cell is the vertex q_n, which no point
///      ●    ∘──∘──…──∘                  ○          reads, nodes 1 … S are the coefficients. Trace stencils join them.
///
///      ●──∘──…──∘──○                               shared: function 0 is the vertex of row 0, function S − 1 that of
///                                                  row 1, the others are nodes inside. The basis has both end nodes.
///
/// Either has a lower side, where a step starts: p = ∂ℓ/∂q̇ at the vertex of row 0. Throws BadInput: `shared` for a basis
/// without end nodes.
StencilTable time_element(const LineBasis&, const LineRule&, Continuity);

}  // namespace delf
