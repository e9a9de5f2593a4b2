// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "jets/tables/splitting.hpp"

namespace delf::peers {

/// One step of an integrator of q′ = p, p′ = A(q) + F(q) as flows of q′ = p, p′ = A(q), A linear, and kicks p′ = F(q):
///
///     flows first:  flow(a_0 h) kick(b_1 h) flow(a_1 h) … kick(b_s h) flow(a_s h)
///     kicks first:  kick(b_0 h) flow(a_1 h) kick(b_1 h) … flow(a_s h) kick(b_s h)
///
/// Palindromes, all of them. `outer` holds s + 1 weights, of what stands first, `inner` s of the other; both sum to 1.
struct Splitting {
  bool flows_first;
  std::vector<double> outer, inner;
  Processor processor = {};  ///< kicks and flows by turns, once before the first step, undone on copies
  double gradient = 0;       ///< g: a kick is of F + 2g h² F′F
};

// The [B, [B, [B, A]]] that vanishes for Nyström methods vanishes here too: the energy of a flow is quadratic in p.

Splitting strang();            ///< order 2, one kick
Splitting blanes_moan_4();     ///< order 4, 6 kicks, kicks first
Splitting blanes_moan_6a();    ///< order 6, 14 kicks, flows first
Splitting blanes_moan_6b();    ///< order 6, 11 kicks, kicks first
Splitting kahan_li_8_flows();  ///< order 8, 17 kicks, flows first
Splitting kahan_li_8_kicks();  ///< the same, kicks first

// The kernels of the engine: ti4, one kick with a gradient, flows first; b6, six kicks, kicks first.
Splitting processed_ti4();
Splitting processed_b6();

/// The symmetric composition of Strang steps of lengths γ_1 h, …, γ_s h, neighbours merged; `half` is γ_1 … γ_(s+1)/2.
Splitting composed(bool flows_first, const std::vector<double>& half);

}  // namespace delf::peers
