// SPDX-License-Identifier: MIT
#include "tools/figures/trace.hpp"

#include <algorithm>

namespace delf {

void Trace::append(double time, double value) {
  constexpr std::size_t capacity = 2000;
  if (!intervals_.empty() && values_in_last_ < values_per_interval_) {
    Interval& last = intervals_.back();
    last = {last.begin, time, std::min(last.least, value), std::max(last.most, value)};
    ++values_in_last_;
    return;
  }
  if (intervals_.size() == capacity) {  // full: merge them two by two
    for (std::size_t i = 0; i < capacity / 2; ++i) {
      const Interval a = intervals_[2 * i], b = intervals_[2 * i + 1];
      intervals_[i] = {a.begin, b.end, std::min(a.least, b.least), std::max(a.most, b.most)};
    }
    intervals_.resize(capacity / 2);
    values_per_interval_ *= 2;
  }
  intervals_.push_back({time, time, value, value});
  values_in_last_ = 1;
}

}  // namespace delf
