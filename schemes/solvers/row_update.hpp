// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>

#include "jets/simd/pack.hpp"

namespace delf {

/// v ← v + w and y ← y + v, pack by pack; of a correction, v ← v + w and y ← y + w. `largest`: |y|, lane by lane.
struct RowUpdate {
  const double *v, *y;
  double *new_v, *new_y;
  Pack of_increment, of_change, largest;
  [[gnu::always_inline]] void operator()(std::ptrdiff_t at, Pack w) {
    const Pack increment = Pack::load(v + at) + w;
    const Pack value = Pack::load(y + at) + (of_increment * increment + of_change * w);
    increment.store(new_v + at);
    value.store(new_y + at);
    largest = largest_magnitude(largest, value);
  }
};

}  // namespace delf
