// SPDX-License-Identifier: MIT
#pragma once
#include "jets/batch_density.hpp"
#include "jets/tables/stencil_table.hpp"

namespace delf {

/// The table for a density that reads t or x: each slot is paired with the place that its own weights have.
///
/// Let c_s be the place of slot s, where its weights are a derivative to second order (place_of), and p the place at which
/// a point reads t and x. On a smooth field the action differs to first order in h and k from ∫ℓ by
///
///     Σ_q w_q [p·∂ℓ + Σ_s (c_s·∂φ_s) ∂ℓ/∂φ_s]        ∂ = (h ∂_t, k ∂_x), at fixed jet in the first term
///
/// Only the means over the points of a stencil matter, P of p and C_s of c_s. If all are equal, the sum is P·(Dℓ), a
/// divergence, and the equations are of second order: rectangles, bricks, six- and nine-tuples. The triangles have three
/// places: of ℓ = V(φ) + T(φ_t) + X(φ_x) without t and x each term is a divergence of its own, whatever its C_s; where a
/// term reads t or x, it must do so at that C_s. Hence a point whose slots lie apart becomes
///
///     w ℓ(p; φ) + Σ_G w [ℓ(c_G; φ_G, slots of G) − ℓ(c_G; φ_G)]
///
/// with a sum over sets G of derivatives that the density couples. These are points of the table, so that equations, forms
/// and plans see an ordinary action. φ_G is φ at the place c_G if the density couples φ with G, and else the point's own,
/// which has no effect. What couples φ_t and φ_x nonlinearly has no place on a triangle, and stays of first order there.
///
/// A set G that reads neither t nor x, or has the place of its points, is left with φ; so is one without which the density has
/// no value, as beside 1/φ_x.
StencilTable with_slot_places(StencilTable, const BatchDensity&);

/// The place where the weights of a slot, exact on polynomials of the slot's own degree, are a derivative to second order:
///
///     c_t = Σ_l w_l t_l^{a+1} x_l^b / ((a+1)! b!),    c_x = Σ_l w_l t_l^a x_l^{b+1} / (a! (b+1)!)        for ∂_t^a ∂_x^b
///
NodePosition place_of(const StencilTable&, const TablePoint&, JetSlot);

}  // namespace delf
