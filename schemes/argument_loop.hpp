// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <utility>

#include "schemes/row_kernel.hpp"
#include "schemes/value_jet.hpp"

namespace delf {

/// out = ∂ℓ/∂φ(m) at a row of arguments, whose unknown part is extrapolated from so many rows first, if any: they are read
/// while the density is worked out. t, and x from the anchor's, are those of the arguments.
template <int past_rows, int stride, Density D>
[[gnu::flatten]] void argument_loop(const D& given_density, const ArgumentRow& given, double given_t,
                                    double x_offset, double* out, const PackRange& packs) {
  // Copies of this function alone: what is stored through others cannot change them, so that they stay in registers.
  const D density = given_density;
  double* const unknown = given.unknown;
  const double* const known = given.known;
  const double known_weight = given.known_weight;
  const double* const positions = given.positions;
  const Pack t(given_t);
  std::array<const double*, past_rows + 1> past;
  std::array<double, past_rows + 1> coefficients;
  int slot = given.slot;
  for (int j = 0; j < past_rows; ++j) {
    past[j] = given.ring + slot * given.stride;
    slot = slot == 0 ? given.slots - 1 : slot - 1;
    coefficients[j] = given.coefficients[j];
  }
  const auto found = [&](std::ptrdiff_t at) __attribute__((always_inline)) {
    if constexpr (past_rows == 0) return Pack::load(unknown + at);
    Pack u = coefficients[0] * Pack::load(past[0] + at);
    for (int j = 1; j < past_rows; ++j) u += coefficients[j] * Pack::load(past[j] + at);
    u.store(unknown + at);
    return u;
  };
  // Where bricks are missing, packs in between are extrapolated too: steps compare u everywhere.
  const std::ptrdiff_t between = packs.first % 2 == 0 ? lanes : -lanes;
  const std::ptrdiff_t end = given.layout->at(packs.last);
  for (std::ptrdiff_t at = given.layout->at(packs.first); at < end; at += stride * lanes) {
    if constexpr (stride == 2 && past_rows > 0) found(at + between);
    const Pack m = found(at) + known_weight * Pack::load(known + at);
    const auto l = density(value_jet<D>([m](int) { return m; }, t, positions + at, x_offset));
    l.derivative(0).store(out + at);
  }
}

/// The loop for so many past rows, none or 2 … most.
template <int stride, Density D>
void argument_loop_for(const D& density, const ArgumentRow& row, double t, double x_offset, double* out,
                       const PackRange& packs) {
  [&]<int... j>(std::integer_sequence<int, j...>) {
    constexpr auto rows = [](int i) { return i == 0 ? 0 : i + 1; };
    ((row.past_rows == rows(j) ? argument_loop<rows(j), stride>(density, row, t, x_offset, out, packs) : void()), ...);
  }
  (std::make_integer_sequence<int, ArgumentRow::most_past_rows>{});
}

}  // namespace delf
