// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <vector>

#include "schemes/stepping/saved_state.hpp"

namespace delf {

/// A quantity over time, of any length in bounded memory: its least and largest values in at most 2000 intervals, so
/// that a figure shows every extreme.
class Trace {
 public:
  struct Interval {
    double begin, end, least, most;
  };
  void append(double time, double value);
  const std::vector<Interval>& intervals() const noexcept { return intervals_; }

  void visit(SavedState& state) {
    state("intervals", intervals_), state("values of an interval", values_per_interval_);
    state("values of the last interval", values_in_last_);
  }

 private:
  std::vector<Interval> intervals_;
  std::size_t values_per_interval_ = 1, values_in_last_ = 0;
};

}  // namespace delf
