// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "jets/density.hpp"
#include "jets/stencil_lagrangian.hpp"

namespace delf {

/// A theory on a submanifold G(φ) = 0 of ℝᵈ: it declares `auto constraint(const auto& phi) const`.
template <class D>
concept Constrained = requires(const D& density, const JetFor<double, D>& j) {
  { density.constraint(j.phi) } -> std::convertible_to<double>;
};

/// G(φ) = 0 at every site, with the multiplier λ there, which is component d:  L = λ G(φ). Its equations are G(φ) = 0,
/// and −Σ ∂L/∂φ = λ ∂G/∂φ in those of φ, so that λ is hk times the multiplier of the continuous theory.
template <class D>
requires Constrained<D>
struct VertexConstraint {
  static constexpr int d = components_of<D>();
  D density;

  StencilPattern pattern() const { return StencilPattern({{0, 0}}); }
  std::vector<VertexValue> values() const {
    std::vector<VertexValue> list;
    for (int a = 0; a <= d; ++a) list.push_back({0, a});
    return list;
  }
  template <class T>
  T operator()(std::span<const T> y, const Cell&) const {
    FibreValue<T, d> phi;
    for (int a = 0; a < d; ++a) component(phi, a) = y[a];
    return y[d] * density.constraint(phi);
  }
};

}  // namespace delf
