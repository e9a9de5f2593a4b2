// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>

#include "jets/simd/pack.hpp"

namespace delf {

/// How well a row of equations is solved: max |E| and max Σ |terms|, pack by pack. A NaN among the terms stays one in the
/// second: it is E only where that is finite.
struct LargestTerms {
  Pack sum = 0.0, absolute = 0.0;

  /// `a`: a sum of absolute values.
  [[gnu::always_inline]] void operator()(std::ptrdiff_t, Pack s, Pack a) {
    sum = detail::larger_magnitude(sum, s);
    absolute = larger_size(absolute, a);
  }
};

}  // namespace delf
