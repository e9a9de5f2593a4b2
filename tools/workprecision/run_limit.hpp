// SPDX-License-Identifier: MIT
#pragma once
#include <chrono>
#include <limits>

#include "tools/report/interrupt.hpp"
#include "tools/report/seconds_since.hpp"
#include "tools/report/step_clock.hpp"

namespace delf {

/// The end of a run before its last row: a moment up to which the user waits, seconds of the processor since it began,
/// or Ctrl-C.
class RunLimit {
 public:
  using Clock = std::chrono::steady_clock;
  explicit RunLimit(Clock::time_point until, double seconds = std::numeric_limits<double>::infinity())
      : until_(until), seconds_(seconds), cost_begin_(clock_.now()) {}

  bool reached() const {
    if (Interrupt::asked()) return true;
    const Clock::time_point now = Clock::now();
    // the processor's clock is slow to read, and never ahead
    return now >= until_ || (seconds_of(now - begin_) > seconds_ && clock_.since(cost_begin_) > seconds_);
  }

 private:
  StepClock clock_{1};
  Clock::time_point begin_ = Clock::now(), until_;
  double seconds_, cost_begin_;
};

}  // namespace delf
