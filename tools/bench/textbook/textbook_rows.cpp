// SPDX-License-Identifier: MIT
#include "tools/bench/textbook/textbook_rows.hpp"

#include <algorithm>

namespace delf::bench {

void PastRows::start(std::span<const double> row0, std::span<const double> row1) {
  newest_ = 0;
  held_ = 1;
  std::ranges::copy(row0, ring_[0].data());
  ring_[0].close();
  std::ranges::copy(row1, next());
  close_next();
  advance();
}

void PastRows::seed_next() {
  double* y = next();
  if (held_ == 8) {
    const double *a = row(0), *b = row(1), *c = row(2), *d = row(3), *e = row(4), *f = row(5), *g = row(6), *o = row(7);
    for (int i = 0; i < sites_; ++i)
      y[i] = 8 * (a[i] + g[i]) - 28 * (b[i] + f[i]) + 56 * (c[i] + e[i]) - 70 * d[i] - o[i];
  } else {
    std::fill_n(y, sites_, 0.0);
    double weight = -1;
    for (int m = 1; m <= held_; ++m) {
      weight *= -static_cast<double>(held_ - m + 1) / m;
      const double* past = row(m - 1);
      for (int i = 0; i < sites_; ++i) y[i] += weight * past[i];
    }
  }
  close_next();
}

}  // namespace delf::bench
