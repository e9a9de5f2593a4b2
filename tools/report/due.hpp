// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <chrono>
#include <cstdint>

#include "tools/report/seconds_since.hpp"

namespace delf {

/// A clock that tells if so many seconds have passed, asked after every step: it is one comparison, and reads the clock
/// some twenty times a second.
class Due {
 public:
  /// Never, if they are 0.
  explicit Due(double seconds) : seconds_(seconds) {}

  bool at(std::int64_t step) { return step >= next_look_ && look(step); }
  void restart() { begin_ = Clock::now(); }

 private:
  using Clock = std::chrono::steady_clock;
  bool look(std::int64_t step) {
    constexpr double between_looks = 0.05;
    const double since = seconds_since(last_look_);
    last_look_ = Clock::now();
    stride_ = since > 2 * between_looks   ? std::max<std::int64_t>(1, stride_ / 2)
              : since < between_looks / 2 ? 2 * stride_
                                          : stride_;
    next_look_ = step + stride_;
    return seconds_ > 0 && seconds_since(begin_) >= seconds_;
  }

  double seconds_;
  std::int64_t next_look_ = 0, stride_ = 1;
  Clock::time_point begin_ = Clock::now(), last_look_ = begin_;
};

}  // namespace delf
