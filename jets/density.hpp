// SPDX-License-Identifier: MIT
#pragma once
#include <concepts>
#include <type_traits>

#include "jets/numbers/dual.hpp"
#include "jets/jet.hpp"

namespace delf {

/// The number of real components of the field on which a density works: D::components, or 1.
template <class D>
constexpr int components_of() {
  if constexpr (requires { D::components; }) return D::components;
  else return 1;
}

/// True if ℓ depends on t and x besides the field, which it says by `static constexpr bool placed = true;`.
template <class D>
constexpr bool is_placed() {
  if constexpr (requires { D::placed; }) return D::placed;
  else return false;
}

/// The number of slots of the jet that ℓ depends on: 3, or 6 with second derivatives, which it says by
/// `static constexpr int jet_order = 2;`.
template <class D>
constexpr int slots_of() {
  if constexpr (requires { D::jet_order; }) return D::jet_order == 2 ? 6 : 3;
  else return 3;
}

/// The jet of numbers T that a density D is called with.
template <class T, class D>
using PlainJetFor =
    std::conditional_t<slots_of<D>() == 6, SecondJet<T, components_of<D>()>, Jet<T, components_of<D>()>>;
template <class T, class D>
using JetFor = std::conditional_t<is_placed<D>(), Placed<T, PlainJetFor<T, D>>, PlainJetFor<T, D>>;

/// A Lagrangian density ℓ(φ, φ_t, φ_x): a function object that works for any kind of number, like
///
///     struct PhiFour {
///       auto operator()(const auto& j) const {
///         const auto w = j.phi * j.phi - 1.0;
///         return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) - 0.25 * w * w;
///       }
///     };
///
/// If this concept fails: the operator must be const, take `const auto& j`, use only j.phi, j.phi_t, j.phi_x (arrays
/// if it declares `static constexpr int components = n`; also j.t, j.x if it declares `placed = true`; also j.phi_tt,
/// j.phi_tx, j.phi_xx if it declares `jet_order = 2`), arithmetic and cos, cosm1 (cos x − 1), tan, exp, log, sqrt, sinh, cosh, tanh, pow(x, double), and return a number of the kind that
/// it was given: `return 1.0` is no density.
template <class D>
concept Density = requires(const D& density, const JetFor<double, D>& numbers, const JetFor<Dual<double, 3>, D>& duals,
                           const JetFor<Dual<Pack, 1>, D>& packs) {
  { density(numbers) } -> std::same_as<double>;         // a density returns ℓ for numbers …
  { density(duals) } -> std::same_as<Dual<double, 3>>;  // … and with derivatives: write `const auto& j` …
  { density(packs) } -> std::same_as<Dual<Pack, 1>>;    // … many sites at a time: no `if` on the field
};

/// The concept as a function that says what is missing, in one line: static_assert(is_density<D>()).
template <class D>
consteval bool is_density() {
  static_assert(Density<D>,
                "delf: this is no Lagrangian density: its operator() must be const, take `const auto& j`, use j.phi, "
                "j.phi_t and j.phi_x by arithmetic and functions such as cos and exp, and return a number of the kind "
                "that it was given, not 1.0 and not void (jets/density.hpp)");
  return true;
}

}  // namespace delf
