// SPDX-License-Identifier: MIT
#include "tools/bench/textbook/textbook_rectangle.hpp"

#include <cmath>
#include <utility>

#include "lattice/index.hpp"

namespace delf::bench {

TextbookRectangle::TextbookRectangle(int sites, WavePart wave, double tolerance)
    : wave_(wave),
      rows_(sites),
      matrix_(sites, wave.a0, wave.a1),
      fixed_point_(tolerance),
      below_(sites),
      above_(sites),
      known_(at(sites)),
      x_(known_) {}

void TextbookRectangle::start(std::span<const double> row0, std::span<const double> row1) {
  rows_.start(row0, row1);
  fixed_point_.start(row0, row1);
  find_sines(rows_.row(1), rows_.row(0), rows_.sites(), below_);
}

void TextbookRectangle::find_sines(const double* lower, const double* upper, int sites, CircleRow& sines) {
  double* s = sines.data();
  for (int i = 0; i < sites; ++i) s[i] = std::sin(0.25 * (lower[i] + lower[i + 1] + upper[i] + upper[i + 1]));
  sines.close();
}

// A y_{n+1} = B y_n − A y_{n−1} − ¼(s_{i−1} + s_i) below − ¼(s_{i−1} + s_i) above, of which only the last changes.
void TextbookRectangle::step() {
  const int N = rows_.sites();
  const double *y = rows_.row(0), *older = rows_.row(1), *below = below_.data();
  for (int i = 0; i < N; ++i) known_[i] = wave_.known(y + i, older + i) - 0.25 * (below[i - 1] + below[i]);
  rows_.seed_next();
  double* next = rows_.next();
  fixed_point_.solve([&] {
    find_sines(y, next, N, above_);
    const double* above = above_.data();
    for (int i = 0; i < N; ++i) x_[i] = known_[i] - 0.25 * (above[i - 1] + above[i]);
    matrix_.solve(x_.data());
    Change change;
    for (int i = 0; i < N; ++i) {
      change.take(next[i], x_[i]);
      next[i] = x_[i];
    }
    rows_.close_next();
    return change;
  });
  rows_.advance();
  std::swap(below_, above_);
}

}  // namespace delf::bench
