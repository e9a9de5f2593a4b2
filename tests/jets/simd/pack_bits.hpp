// SPDX-License-Identifier: MIT
#pragma once
#include <bit>
#include <cstdint>

#include "jets/simd/pack.hpp"
#include "tests/jets/random.hpp"

namespace delf::testing {

/// Lanes whose bits differ.
inline int different(Pack a, Pack b) {
  int count = 0;
  for (int l = 0; l < lanes; ++l) count += std::bit_cast<std::uint64_t>(a[l]) != std::bit_cast<std::uint64_t>(b[l]);
  return count;
}
inline Pack random_pack(Random& random, double bound) {
  Pack x;
  for (int l = 0; l < lanes; ++l) x.v[l] = random(-bound, bound);
  return x;
}

}  // namespace delf::testing
