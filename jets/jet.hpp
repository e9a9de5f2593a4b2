// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <type_traits>

namespace delf {

/// One number for a scalar field, an array of them for a field with values in ℝⁿ.
template <class T, int components>
using FibreValue = std::conditional_t<components == 1, T, std::array<T, static_cast<std::size_t>(components)>>;

/// The continuous first jet (φ, φ_t, φ_x) that the values on a stencil stand for, at one quadrature point.
template <class T, int components = 1>
struct Jet {
  FibreValue<T, components> phi, phi_t, phi_x;
};

/// A jet that knows its place: for densities ℓ(t, x, φ, φ_t, φ_x).
template <class T, int components = 1>
struct PlacedJet : Jet<T, components> {
  T t, x;
};

/// The component a of a fibre value, whether it is one number or an array.
template <class T>
constexpr T& component(T& value, int) {
  return value;
}
template <class T, std::size_t n>
constexpr T& component(std::array<T, n>& value, int a) {
  return value[static_cast<std::size_t>(a)];
}

}  // namespace delf
