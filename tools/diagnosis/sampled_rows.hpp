// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "tools/diagnosis/evidence.hpp"
#include "tools/diagnosis/own_equations.hpp"

namespace delf {

/// The number of rows that a fit takes: 40 at most, spread over those that have an equation on three rows.
inline std::int64_t sampled_rows(const Evidence& e) { return std::min<std::int64_t>(40, e.rows - 2); }

/// Calls look(n, rows, E) for n = 0, 1, … of them, with the row, the ones below and above it, and its equations. Returns the
/// largest |y| of these rows. `monodromy` is φ(x + L) − φ(x).
template <class Look>
double look_at_sampled_rows(const Evidence& e, double monodromy, const Look& look) {
  const std::int64_t count = sampled_rows(e);
  double largest = 0;
  std::vector<LatticeSystem::Value> E;
  for (std::int64_t n = 0; n < count; ++n) {
    const std::int64_t j = 1 + (e.rows - 3) * n / std::max<std::int64_t>(count - 1, 1);
    const std::vector<std::vector<double>> rows{e.row(j - 1), e.row(j), e.row(j + 1)};
    largest = std::max(largest, largest_of(rows));
    e.system.equations(e.system.window(j - 1, rows, monodromy), j, E);
    look(n, rows, E);
  }
  return largest;
}

}  // namespace delf
