// SPDX-License-Identifier: MIT
#include "tools/bench/textbook/textbook_triangle.hpp"

#include <cmath>
#include <utility>

#include "lattice/index.hpp"

namespace delf::bench {

TextbookTriangle::TextbookTriangle(int N, double L, double h, double tolerance)
    : squared_ratio_(h * N / L * (h * N / L)),
      third_(h * h / 3),
      rows_(N),
      fixed_point_(tolerance),
      below_(N),
      above_(N),
      known_(at(N)) {}

void TextbookTriangle::start(std::span<const double> row0, std::span<const double> row1) {
  rows_.start(row0, row1);
  fixed_point_.start(row0, row1);
  const double *lower = rows_.row(1), *upper = rows_.row(0);
  double *s = below_.data();
  for (int i = 0; i < rows_.sites(); ++i) s[i] = std::sin((lower[i] + upper[i] + upper[i + 1]) * (1. / 3));
  below_.close();
}

// y_{n+1} = 2y_n − y_{n−1} + (h/k)² ∂²_k y_n − ⅓h² (s_{i−1} + s_i) below − ⅓h² s_i above. Both loops fused: y[i+1] is
// still that of the pass before when site i is improved.
void TextbookTriangle::step() {
  const int N = rows_.sites();
  const double *y = rows_.row(0), *older = rows_.row(1), *below = below_.data();
  for (int i = 0; i < N; ++i)
    known_[i] =
        2 * y[i] - older[i] + squared_ratio_ * (y[i + 1] - 2 * y[i] + y[i - 1]) - third_ * (below[i - 1] + below[i]);
  rows_.seed_next();
  double *next = rows_.next(), *above = above_.data();
  fixed_point_.solve([&] {
    Change change;
    for (int i = 0; i < N; ++i) {
      above[i] = std::sin((y[i] + next[i] + next[i + 1]) * (1. / 3));
      const double better = known_[i] - third_ * above[i];
      change.take(next[i], better);
      next[i] = better;
    }
    rows_.close_next();
    return change;
  });
  rows_.advance();
  above_.close();
  std::swap(below_, above_);
}

}  // namespace delf::bench
