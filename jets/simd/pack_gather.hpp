// SPDX-License-Identifier: MIT
#pragma once
#include <cstring>
#include <utility>

#include "jets/simd/pack.hpp"

namespace delf {

/// Numbers in a row, wherever they begin.
[[gnu::always_inline]] inline Pack load_unaligned(const double* from) {
  Pack result;
  std::memcpy(&result, from, sizeof result);
  return result;
}

// Lane by lane: the processors' own instructions for packs take longer.

namespace detail {
// All lanes are listed at once: lanes that are set one after the other wait for each other.
template <int... l>
[[gnu::always_inline]] inline Pack gather(const double* from, const int* index, std::integer_sequence<int, l...>) {
  return {Pack::Vector{from[index[l]]...}};
}
}  // namespace detail

/// Lane l is from[index[l]].
[[gnu::always_inline]] inline Pack gather(const double* from, const int* index) {
  return detail::gather(from, index, std::make_integer_sequence<int, lanes>{});
}

/// to[index[l]] = lane l; of lanes that go to one place, the last.
[[gnu::always_inline]] inline void scatter(Pack a, double* to, const int* index) {
  for (int l = 0; l < lanes; ++l) to[index[l]] = a[l];
}

/// to[index[l]] += lane l, of the first `count` lanes.
[[gnu::always_inline]] inline void scatter_add(Pack a, double* to, const int* index, int count) {
  if (count >= lanes)
    for (int l = 0; l < lanes; ++l) to[index[l]] += a[l];
  else
    for (int l = 0; l < count; ++l) to[index[l]] += a[l];
}

}  // namespace delf
