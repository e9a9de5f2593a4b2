// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <span>

namespace delf::bench {

/// The effect of one pass of a fixed point on its row: max |Δy| and max |y|.
struct Change {
  double change = 0, value = 0;

  void take(double before, double after) {
    change = std::max(change, std::abs(after - before));
    value = std::max(value, std::abs(after));
  }
};

/// Stops when max |Δy| ≤ tolerance · max |y|, the latter over the newest three rows.
class FixedPoint {
 public:
  explicit FixedPoint(double tolerance) : tolerance_(tolerance) {}

  void start(std::span<const double> row0, std::span<const double> row1) {
    passes_ = 0;
    largest_[1] = size(row0);
    largest_[0] = size(row1);
  }
  template <class Pass>
  void solve(Pass&& pass) {
    Change last;
    for (int iterations = 1; iterations <= 50; ++iterations) {
      last = pass();
      ++passes_;
      if (last.change <= tolerance_ * std::max({last.value, largest_[0], largest_[1]})) break;
    }
    largest_[1] = largest_[0];
    largest_[0] = last.value;
  }
  long passes() const { return passes_; }  ///< since the start

 private:
  static double size(std::span<const double> row) {
    double largest = 0;
    for (const double y : row) largest = std::max(largest, std::abs(y));
    return largest;
  }
  double tolerance_, largest_[2] = {0, 0};
  long passes_ = 0;
};

}  // namespace delf::bench
