// SPDX-License-Identifier: MIT
#include "tools/bench/textbook/textbook_guo.hpp"

#include "lattice/index.hpp"
#include "tools/bench/textbook/textbook_quotient.hpp"

namespace delf::bench {

TextbookGuo::TextbookGuo(int N, double L, double h, double tolerance)
    : squared_ratio_(h * N / L * (h * N / L)), squared_step_(h * h), rows_(N), fixed_point_(tolerance), known_(at(N)) {}

void TextbookGuo::start(std::span<const double> row0, std::span<const double> row1) {
  rows_.start(row0, row1);
  fixed_point_.start(row0, row1);
}

void TextbookGuo::step() {
  const int N = rows_.sites();
  const double *y = rows_.row(0), *older = rows_.row(1);
  for (int i = 0; i < N; ++i) known_[i] = 2 * y[i] - older[i] + squared_ratio_ * (y[i + 1] - 2 * y[i] + y[i - 1]);
  rows_.seed_next();
  double* next = rows_.next();
  fixed_point_.solve([&] {
    Change change;
    for (int i = 0; i < N; ++i) {
      const double better = known_[i] - squared_step_ * quotient(next[i], older[i]);
      change.take(next[i], better);
      next[i] = better;
    }
    return change;
  });
  rows_.close_next();
  rows_.advance();
}

}  // namespace delf::bench
