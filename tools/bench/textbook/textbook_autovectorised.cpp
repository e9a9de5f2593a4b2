// SPDX-License-Identifier: MIT
#include "tools/bench/textbook/textbook_autovectorised.hpp"

#include <cmath>

namespace delf::bench {

namespace {

inline double next_value(double left, double y, double right, double older, double squared_ratio, double squared_step) {
  return 2 * y - older + squared_ratio * (right - 2 * y + left) - squared_step * std::sin(y);
}

}  // namespace

// y_{n+1} = 2y_n − y_{n−1} + (h/k)² ∂²_k y_n − h² sin y_n
void autovectorised_step(const double* __restrict y, double* __restrict next, int N, double r2, double h2) {
  next[0] = next_value(y[N - 1], y[0], y[1], next[0], r2, h2);
  for (int i = 1; i < N - 1; ++i) next[i] = next_value(y[i - 1], y[i], y[i + 1], next[i], r2, h2);
  next[N - 1] = next_value(y[N - 2], y[N - 1], y[0], next[N - 1], r2, h2);
}

void autovectorised_sine(const double* __restrict x, double* __restrict out, int count) {
  for (int i = 0; i < count; ++i) out[i] = std::sin(x[i]);
}

}  // namespace delf::bench
