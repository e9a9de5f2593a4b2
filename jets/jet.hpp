// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <type_traits>

#include "lattice/index.hpp"

namespace delf {

/// One number for a scalar field, an array of them for a field with values in ℝⁿ.
template <class T, int components>
using FibreValue = std::conditional_t<components == 1, T, std::array<T, at(components)>>;

/// The continuous first jet (φ, φ_t, φ_x) that the values on a stencil stand for, at one quadrature point.
template <class T, int components = 1>
struct Jet {
  FibreValue<T, components> phi, phi_t, phi_x;
};

/// The second jet: for densities of second derivatives too.
template <class T, int components = 1>
struct SecondJet : Jet<T, components> {
  FibreValue<T, components> phi_tt, phi_tx, phi_xx;
};

/// A jet that knows its place: for densities ℓ(t, x, φ, φ_t, φ_x).
template <class T, class J>
struct Placed : J {
  T t, x;
};
template <class T, int components = 1>
using PlacedJet = Placed<T, Jet<T, components>>;

/// The component a of a fibre value, whether it is one number or an array.
template <class T>
constexpr T& component(T& value, int) {
  return value;
}
template <class T, std::size_t n>
constexpr T& component(std::array<T, n>& value, int a) {
  return value[a];
}

/// Component a of slot number s, in the order of jets: φ, φ_t, φ_x, φ_tt, φ_tx, φ_xx.
template <class J>
constexpr auto& jet_slot(J& jet, int s, int a) {
  if constexpr (requires { jet.phi_tt; }) {
    if (s >= 3) return component(s == 3 ? jet.phi_tt : s == 4 ? jet.phi_tx : jet.phi_xx, a);
  }
  return component(s == 0 ? jet.phi : s == 1 ? jet.phi_t : jet.phi_x, a);
}

}  // namespace delf
