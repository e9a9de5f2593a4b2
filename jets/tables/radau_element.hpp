// SPDX-License-Identifier: MIT
#pragma once
#include "jets/tables/stencil_table.hpp"

namespace delf {

/// The Runge–Kutta method Radau IIA of s stages for p = ∂ℓ/∂φ_t, dp/dt = ∂ℓ/∂φ, on one site; order 2s − 1, and not
/// variational: its residuals are the gradient of no action.
///
/// Q is the polynomial of degree s through the vertex of row 0 and the stages Q_i at c_i, with c_s = 1 the vertex of row
/// 1 and the others nodes inside. With P_i = ∂ℓ/∂φ_t and F_i = ∂ℓ/∂φ of the jet at c_i, and Butcher's A and b,
///
///     P_i = p_n + h Σ_j a_ij F_j,    P_s = p_{n+1} = p_n + h Σ_j b_j F_j                Hairer–Wanner II, IV.5
///
/// read, without p_n, as residuals of the vertices and nodes: those of the vertices add up to momenta, as if there were
/// an action,
///
///     r^0 = h Σ_j b_j F_j − P_s,    r^s = P_s,    r^i = P_i − P_s − h Σ_j (a_ij − b_j) F_j.
///
StencilTable radau_element(int stages);

}  // namespace delf
