// SPDX-License-Identifier: MIT
#include "tools/bench/textbook/textbook_explicit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace delf::bench {

TextbookExplicit::TextbookExplicit(int N, double L, double h, double)
    : sites_(N), squared_ratio_(h * N / L * (h * N / L)), squared_step_(h * h), newest_(N), older_(N) {}

void TextbookExplicit::start(std::span<const double> row0, std::span<const double> row1) {
  std::ranges::copy(row0, older_.data());
  std::ranges::copy(row1, newest_.data());
  newest_.close();
}

void TextbookExplicit::step() {
  const double* y = newest_.data();
  double* next = older_.data();  // the row before is needed only where it is replaced
  for (int i = 0; i < sites_; ++i)
    next[i] = 2 * y[i] - next[i] + squared_ratio_ * (y[i + 1] - 2 * y[i] + y[i - 1]) - squared_step_ * std::sin(y[i]);
  older_.close();
  std::swap(newest_, older_);
}

}  // namespace delf::bench
