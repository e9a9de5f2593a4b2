// SPDX-License-Identifier: MIT
#pragma once
#include "jets/simd/pack.hpp"

namespace delf {

/// Lane l is from[index[l]].
inline Pack gather(const double* from, const int* index) {
#if defined(__AVX512F__) && defined(__AVX512VL__)
  // Masks of all lanes spare gcc a warning about its own headers.
  const __m256i places = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(index));
  return {_mm512_mask_i32gather_pd(_mm512_setzero_pd(), 0xff, places, from, sizeof(double))};
#else
  Pack result;
  for (int l = 0; l < lanes; ++l) result.v[l] = from[index[l]];
  return result;
#endif
}

/// to[index[l]] = lane l; of lanes that go to one place, the last.
inline void scatter(Pack a, double* to, const int* index) {
#if defined(__AVX512F__) && defined(__AVX512VL__)
  const __m256i places = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(index));
  _mm512_i32scatter_pd(to, places, a.v, sizeof(double));
#else
  for (int l = 0; l < lanes; ++l) to[index[l]] = a[l];
#endif
}

}  // namespace delf
