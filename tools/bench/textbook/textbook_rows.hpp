// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "lattice/index.hpp"

namespace delf::bench {

/// A row on a circle with two ghost sites on either side, so that loops need no case for the ends: y[−2] … y[N+1].
class CircleRow {
 public:
  explicit CircleRow(int sites) : sites_(sites), data_(at(sites) + 4) {}
  double* data() { return data_.data() + 2; }
  const double* data() const { return data_.data() + 2; }
  void close() {
    double* y = data();
    y[-2] = y[sites_ - 2], y[-1] = y[sites_ - 1], y[sites_] = y[0], y[sites_ + 1] = y[1];
  }

 private:
  int sites_;
  std::vector<double> data_;
};

/// The newest eight rows, and the unknown one.
class PastRows {
 public:
  explicit PastRows(int sites) : sites_(sites), ring_(9, CircleRow(sites)) {}

  int sites() const { return sites_; }
  void start(std::span<const double> row0, std::span<const double> row1);

  const double* row(int back) const { return ring_[slot(back)].data(); }  ///< 0 is the newest
  double* next() { return ring_[slot(-1)].data(); }
  void close_next() { ring_[slot(-1)].close(); }
  /// y_{n+1} = Σ_{m=1}^{p} (−1)^{m+1} C(p, m) y_{n+1−m}, the polynomial through the last p = 8 rows, or as many as
  /// there are.
  void seed_next();
  void advance() {
    newest_ = slot(-1);
    if (held_ < 8) ++held_;
  }
  std::span<const double> newest() const { return {row(0), at(sites_)}; }

 private:
  std::size_t slot(int back) const { return (newest_ + 9 - at(back + 9) % 9) % 9; }

  int sites_, held_ = 0;
  std::size_t newest_ = 0;
  std::vector<CircleRow> ring_;
};

}  // namespace delf::bench
