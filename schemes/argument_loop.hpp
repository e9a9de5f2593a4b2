// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <utility>

#include "schemes/row_kernel.hpp"
#include "schemes/value_jet.hpp"

namespace delf {

/// out = output(u, known, at) for the packs of a row of arguments, whose unknown part u is extrapolated from so many
/// rows first, if any: they are read while the output is worked out.
template <int past_rows, int stride, class Output>
[[gnu::flatten]] void argument_loop(const Output& given_output, const ArgumentRow& given, double* out,
                                    const PackRange& packs) {
  // Copies of this function alone: what is stored through others cannot change them, so that they stay in registers.
  const Output output = given_output;
  double* const unknown = given.unknown;
  const double* const known = given.known;
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
    output(found(at), Pack::load(known + at), at).store(out + at);
  }
}

/// The loop for so many past rows, none or 2 … most.
template <int stride, class Output>
void argument_loop_for(const Output& output, const ArgumentRow& row, double* out, const PackRange& packs) {
  [&]<int... j>(std::integer_sequence<int, j...>) {
    constexpr auto rows = [](int i) { return i == 0 ? 0 : i + 1; };
    ((row.past_rows == rows(j) ? argument_loop<rows(j), stride>(output, row, out, packs) : void()), ...);
  }
  (std::make_integer_sequence<int, ArgumentRow::most_past_rows>{});
}

/// ∂ℓ/∂φ at the mixture m = u + known_weight · known; t, and x from the anchor's, are those of the arguments.
template <Density D>
struct MixtureSlope {
  D density;
  double known_weight;
  Pack t;
  const double* positions;
  double x_offset;

  [[gnu::always_inline]] Pack operator()(Pack u, Pack known, std::ptrdiff_t at) const {
    const Pack m = u + known_weight * known;
    return density(value_jet<D>([m](int) { return m; }, t, positions + at, x_offset)).derivative(0);
  }
};

}  // namespace delf
