// SPDX-License-Identifier: MIT
#include "tools/bench/textbook/textbook_hexagon.hpp"

#include <cmath>
#include <utility>

#include "lattice/index.hpp"

namespace delf::bench {

TextbookHexagon::TextbookHexagon(int N, double L, double h, double tolerance)
    : wave_(WavePart::rectangle(h, L / N)),
      rows_(N),
      matrix_(N, wave_.a0, wave_.a1),
      fixed_point_(tolerance),
      below_(N),
      above_(N),
      known_(at(N)),
      x_(known_) {}

void TextbookHexagon::start(std::span<const double> row0, std::span<const double> row1) {
  rows_.start(row0, row1);
  fixed_point_.start(row0, row1);
  parity_ = 1;
  find_sines(rows_.row(1), rows_.row(0), 0, rows_.sites(), below_);
}

void TextbookHexagon::find_sines(const double* lower, const double* upper, int first, int sites, CircleRow& sines) {
  double* s = sines.data();
  for (int i = first; i < sites; i += 2)
    s[i] = std::sin((lower[i] + lower[i + 1] + lower[i + 2] + upper[i] + upper[i + 1] + upper[i + 2]) * (1. / 6));
  sines.close();
}

void TextbookHexagon::step() {
  constexpr double third = 1. / 3;
  const int N = rows_.sites(), even = parity_, odd = 1 - parity_;
  const double *y = rows_.row(0), *older = rows_.row(1), *below = below_.data();
  for (int i = even; i < N; i += 2) known_[i] = wave_.known(y + i, older + i) - third * below[i - 1];
  for (int i = odd; i < N; i += 2) known_[i] = wave_.known(y + i, older + i) - third * (below[i - 2] + below[i]);
  rows_.seed_next();
  double* next = rows_.next();
  fixed_point_.solve([&] {
    find_sines(y, next, even, N, above_);
    const double* above = above_.data();
    for (int i = even; i < N; i += 2) x_[i] = known_[i] - third * (above[i - 2] + above[i]);
    for (int i = odd; i < N; i += 2) x_[i] = known_[i] - third * above[i - 1];
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
  parity_ = 1 - parity_;
}

}  // namespace delf::bench
