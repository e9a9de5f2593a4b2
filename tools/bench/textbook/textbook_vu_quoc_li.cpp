// SPDX-License-Identifier: MIT
#include "tools/bench/textbook/textbook_vu_quoc_li.hpp"

#include "lattice/index.hpp"
#include "tools/bench/textbook/textbook_quotient.hpp"

namespace delf::bench {

TextbookVuQuocLi::TextbookVuQuocLi(int N, double L, double h, double tolerance)
    : wave_(WavePart::rectangle(h, L / N)),
      rows_(N),
      matrix_(N, wave_.a0, wave_.a1),
      fixed_point_(tolerance),
      quotients_(at(N)),
      known_(quotients_),
      x_(quotients_) {}

void TextbookVuQuocLi::start(std::span<const double> row0, std::span<const double> row1) {
  rows_.start(row0, row1);
  fixed_point_.start(row0, row1);
  for (std::size_t i = 0; i < quotients_.size(); ++i) quotients_[i] = quotient(row1[i], row0[i]);
}

void TextbookVuQuocLi::step() {
  const int N = rows_.sites();
  const double *y = rows_.row(0), *older = rows_.row(1);
  for (int i = 0; i < N; ++i) known_[i] = wave_.known(y + i, older + i) - 0.5 * quotients_[i];
  rows_.seed_next();
  double* next = rows_.next();
  fixed_point_.solve([&] {
    for (int i = 0; i < N; ++i) {
      quotients_[i] = quotient(next[i], y[i]);
      x_[i] = known_[i] - 0.5 * quotients_[i];
    }
    matrix_.solve(x_.data());
    Change change;
    for (int i = 0; i < N; ++i) {
      change.take(next[i], x_[i]);
      next[i] = x_[i];
    }
    return change;
  });
  rows_.close_next();
  rows_.advance();
}

}  // namespace delf::bench
