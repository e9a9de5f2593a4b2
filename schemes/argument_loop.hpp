// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <utility>

#include "schemes/row_kernel.hpp"
#include "schemes/value_jet.hpp"

namespace delf {

/// The unknown part u of arguments, pack by pack: as it stands, or extrapolated from so many rows, and put there.
template <int past_rows>
class UnknownArgument {
 public:
  explicit UnknownArgument(const ArgumentRow& given) : unknown_(given.unknown) {
    for (int j = 0; j < past_rows; ++j) past_[j] = given.past[j], coefficients_[j] = given.coefficients[j];
  }
  [[gnu::always_inline]] Pack operator()(std::ptrdiff_t at) const {
    if constexpr (past_rows == 0) return Pack::load(unknown_ + at);
    Pack u = coefficients_[0] * Pack::load(past_[0] + at);
    for (int j = 1; j < past_rows; ++j) u += coefficients_[j] * Pack::load(past_[j] + at);
    u.store(unknown_ + at);
    return u;
  }

 private:
  double* unknown_;
  std::array<const double*, past_rows + 1> past_;
  std::array<double, past_rows + 1> coefficients_;
};

/// `run` with past_rows, none or 2 … most, as a constant.
template <int most, class Run>
[[gnu::always_inline]] inline void with_past_rows(int past_rows, const Run& run) {
  [&]<int... j>(std::integer_sequence<int, j...>) __attribute__((always_inline)) {
    constexpr auto rows = [](int i) { return i == 0 ? 0 : i + 1; };
    ((past_rows == rows(j) ? run.template operator()<rows(j)>() : void()), ...);
  }
  (std::make_integer_sequence<int, most>{});
}

/// Fetches the rows of SlabRows::ahead, so many packs at a time; where none is wanted, one that is in the cache anyway.
template <int packs = 1>
class FetchAhead {
 public:
  explicit FetchAhead(const SlabRows& rows) {
    for (std::size_t r = 0; r < rows_.size(); ++r) rows_[r] = rows.ahead[r] ? rows.ahead[r] : rows.values[0];
  }
  [[gnu::always_inline]] void fetch(std::ptrdiff_t at) const {
    for (const double* row : rows_)  // into the second level: they are a strip
      for (int v = 0; v < packs; ++v) __builtin_prefetch(row + at + v * lanes, 0, 2);
  }

 private:
  decltype(SlabRows::ahead) rows_;
};

/// evaluate(at, find(at)) from pack to pack. What is evaluated is found two packs ahead: evaluations that wait for theirs
/// would keep others waiting. At the end the last one is found again.
template <class Find, class Evaluate>
[[gnu::always_inline]] inline void find_ahead(std::ptrdiff_t at, std::ptrdiff_t end, std::ptrdiff_t by, const Find& find,
                                              const Evaluate& evaluate) {
  if (at >= end) return;
  const std::ptrdiff_t last = at + (end - at - 1) / by * by;
  auto here = find(at), next = find(std::min(at + by, last));
  for (; at < end; at += by) {
    const auto ahead = find(std::min(at + 2 * by, last));
    evaluate(at, here);
    here = next, next = ahead;
  }
}

/// out = output(output.argument(u, known), at) for the packs of a row of arguments: where u is extrapolated, that is done
/// while the output is worked out.
template <int past_rows, int stride, class Output>
[[gnu::flatten]] void argument_loop(const Output& given_output, const ArgumentRow& given, double* out,
                                    const PackRange& packs) {
  // Copies of this function alone: what is stored through others cannot change them, so that they stay in registers.
  const Output output = given_output;
  const UnknownArgument<past_rows> found(given);
  const double* const known = given.known;
  // Where bricks are missing, packs in between are extrapolated too: steps compare u everywhere.
  const std::ptrdiff_t between = packs.first % 2 == 0 ? lanes : -lanes;
  const auto find = [&](std::ptrdiff_t at) __attribute__((always_inline)) {
    if constexpr (stride == 2 && past_rows > 0) found(at + between);
    return output.argument(found(at), Pack::load(known + at));
  };
  find_ahead(given.layout->at(packs.first), given.layout->at(packs.last), stride * lanes, find,
             [&](std::ptrdiff_t at, const auto& argument) __attribute__((always_inline)) {
               output(argument, at).store(out + at);
             });
  given.layout->fill_halo(out, given.is_read_before, given.is_read_after);
}

template <int stride, class Output>
void argument_loop_for(const Output& output, const ArgumentRow& row, double* out, const PackRange& packs) {
  with_past_rows<ArgumentRow::most_past_rows>(
      row.past_rows, [&]<int past_rows>() { argument_loop<past_rows, stride>(output, row, out, packs); });
}

/// ∂ℓ/∂φ at the mixture m = u + known_weight · known; t, and x from the anchor's, are those of the arguments.
template <Density D>
struct MixtureSlope {
  D density;
  double known_weight, t;
  const double* positions;
  double x_offset;

  [[gnu::always_inline]] Pack argument(Pack u, Pack known) const { return u + known_weight * known; }
  [[gnu::always_inline]] Pack operator()(Pack m, std::ptrdiff_t at) const {
    return density(value_jet<D>([m](int) { return m; }, Pack(t), positions + at, x_offset)).derivative(0);
  }
};

}  // namespace delf
