// SPDX-License-Identifier: MIT
#pragma once
#include <concepts>
#include <span>
#include <vector>

#include "jets/discrete_lagrangian.hpp"
#include "jets/numbers/dual.hpp"
#include "lattice/stencil_shape.hpp"

namespace delf {

/// A discrete Lagrangian stated on the values of a stencil themselves, where no jet map fits: a constraint with its
/// multiplier, a moving mesh, a polynomial. A function object like
///
///     struct Spring {                                                     // L = (y₂ − y₁)²/2h
///       delf::StencilPattern pattern() const { return delf::StencilPattern({{0, 0}, {1, 0}}); }
///       std::vector<delf::VertexValue> values() const { return {{0, 0}, {1, 0}}; }       // {vertex, component}
///       template <class T>
///       T operator()(std::span<const T> y, const delf::Cell& cell) const {
///         return (y[1] - y[0]) * (y[1] - y[0]) / (2 * cell.time_step);
///       }
///     };
///
/// If this concept fails: pattern() and values() must be const and return these types, and the operator must be const
/// and work for any kind of number T, with y[i] the number that values()[i] names.
template <class L>
concept StencilLagrangian = requires(const L& lagrangian, std::span<const double> y,
                                     std::span<const Dual<double, 8>> duals, const Cell& cell) {
  { lagrangian.pattern() } -> std::convertible_to<StencilPattern>;
  { lagrangian.values() } -> std::convertible_to<std::vector<VertexValue>>;
  { lagrangian(y, cell) } -> std::convertible_to<double>;
  { lagrangian(duals, cell) } -> std::convertible_to<Dual<double, 8>>;
};

}  // namespace delf
