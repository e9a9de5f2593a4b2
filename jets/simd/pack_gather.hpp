// SPDX-License-Identifier: MIT
#pragma once
#include "jets/simd/pack.hpp"

namespace delf {

// Lane by lane: the processors' own instructions for packs take longer.

/// Lane l is from[index[l]].
[[gnu::always_inline]] inline Pack gather(const double* from, const int* index) {
  Pack result;
  for (int l = 0; l < lanes; ++l) result.v[l] = from[index[l]];
  return result;
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
