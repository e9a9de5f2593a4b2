// SPDX-License-Identifier: MIT
#pragma once
#include "jets/tables/stencil_table.hpp"

namespace delf {

/// A table of time on one site × a table of space in one row: with the functions ψ_a(t) and χ_b(x),
///
///     φ = Σ_ab ψ_a χ_b y_ab,    φ_t = Σ_ab ψ′_a χ_b y_ab,    φ_x = Σ_ab ψ_a χ′_b y_ab,    weights w_r w_s.
///
///     ●──∘──○      degree two in time and in space: the unit cell has the nodes a·2 + b, a, b < 2. Vertices are in
///     ∘──∘──∘      the order l = a · (vertices of space) + b.
///     ●──∘──○
///
/// Its lower side is the table of space: a time table starts at node 0 of row 0.
StencilTable product(const StencilTable& time, const StencilTable& space);

/// The table of time of such a product at the site of its anchor, whose nodes keep their numbers: functions and weights of
/// space add up to 1.
StencilTable at_one_site(const StencilTable& product);

}  // namespace delf
