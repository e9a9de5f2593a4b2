// SPDX-License-Identifier: MIT
#pragma once
#include <chrono>
#include <cstdint>

namespace delf {

/// The progress of a run, on stderr: a bar with the time left on a terminal, a plain line now and then elsewhere,
/// nothing for runs of a second or two.
class Progress {
 public:
  /// Nothing is shown for runs of this thread: whoever calls shows it.
  static inline thread_local bool silent = false;

  /// `unit` is the word for a step.
  explicit Progress(std::int64_t steps, const char* unit = "step");
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Call after every step: it is one comparison, and reads the clock some twenty times a second.
  void at(std::int64_t step) {
    if (step >= next_look_) look(step);
  }

 private:
  using Clock = std::chrono::steady_clock;
  void look(std::int64_t step);
  void draw_bar(std::int64_t step, double left) const;
  void print_line(std::int64_t step, double elapsed, double left);

  const char* unit_;
  std::int64_t steps_, next_look_ = 1, stride_ = 1, step_printed_ = 0;
  Clock::time_point begin_, last_look_, last_shown_;
  bool terminal_, shown_ = false;
};

}  // namespace delf
