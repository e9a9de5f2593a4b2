// SPDX-License-Identifier: MIT
#include "tools/report/step_clock.hpp"

#include <algorithm>
#include <ctime>

namespace delf {

namespace {

double seconds_of(clockid_t clock) {
  std::timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// The least that two readings are apart.
double cost_of_reading(clockid_t clock) {
  double least = 1e-6;
  for (int i = 0; i < 32; ++i) {
    const double from = seconds_of(clock);
    least = std::min(least, seconds_of(clock) - from);
  }
  return least;
}

}  // namespace

StepClock::StepClock(int threads) : of_thread_(threads <= 1) {
  static const double of_thread = cost_of_reading(CLOCK_THREAD_CPUTIME_ID), of_wall = cost_of_reading(CLOCK_MONOTONIC);
  reading_ = of_thread_ ? of_thread : of_wall;
}

double StepClock::now() const { return seconds_of(of_thread_ ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC); }

double StepClock::since(double from) const { return std::max(1e-9, now() - from - reading_); }

const char* time_of_steps(int threads) { return threads <= 1 ? "processor time" : "wall time"; }

}  // namespace delf
