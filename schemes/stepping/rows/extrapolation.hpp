// SPDX-License-Identifier: MIT
#pragma once

namespace delf {

/// The polynomial through the last `rows` rows, one step on: x_{n+1} = Σ_{j=1}^{rows} weight(rows, j) x_{n+1−j} with
/// weight(rows, j) = (−1)^{j+1} C(rows, j).
constexpr double extrapolation_weight(int rows, int j) {
  double ways = 1;
  for (int i = 1; i <= j; ++i) ways = ways * (rows + 1 - i) / i;  // whole numbers all the way
  return j % 2 == 0 ? -ways : ways;
}

}  // namespace delf
