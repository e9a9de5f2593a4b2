// SPDX-License-Identifier: MIT
#pragma once
#include "jets/density.hpp"
#include "jets/simd/near_packs.hpp"

namespace delf {

/// The jet (φ, 0, 0) of a pack of sites, with ∂/∂φ: all that is asked of a density that is nonlinear in φ alone.
/// `value(a)` is the component a of φ, called once for each; `positions` is x of the pack's sites, read if the density
/// is placed, to which `x_offset` is added. `Value`: Pack, NearPack, or NearPacks, of packs that follow each other.
template <Density D, class Value = Pack>
[[gnu::always_inline]] inline auto value_jet(const auto& value, const Pack& t, const double* positions,
                                             double x_offset = 0) {
  constexpr int d = components_of<D>();
  using Number = Dual<Value, d>;
  JetFor<Number, D> jet;
  for (int a = 0; a < d; ++a) {
    component(jet.phi, a) = Number::variable(value(a), a);
    component(jet.phi_t, a) = Number(0.0);
    component(jet.phi_x, a) = Number(0.0);
  }
  if constexpr (is_placed<D>()) {
    jet.t = Number(Value(t));
    jet.x = Number(of_packs<Value>(0, [&](std::ptrdiff_t to) __attribute__((always_inline)) {
      return Pack::load(positions + to) + x_offset;
    }));
  }
  return jet;
}

}  // namespace delf
