// SPDX-License-Identifier: MIT
#include "tools/workprecision/step_clock.hpp"

#include <algorithm>
#include <ctime>

namespace delf {

StepClock::StepClock(int threads) : of_thread_(threads <= 1) {
  double least = 1e-6;
  for (int i = 0; i < 32; ++i) {
    const double from = now();
    least = std::min(least, now() - from);
  }
  reading_ = least;
}

double StepClock::now() const {
  std::timespec time{};
  clock_gettime(of_thread_ ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double StepClock::since(double from) const { return std::max(1e-9, now() - from - reading_); }

const char* time_of_steps(int threads) { return threads <= 1 ? "processor time" : "wall time"; }

}  // namespace delf
