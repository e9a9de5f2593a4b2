// SPDX-License-Identifier: MIT
#include "tools/report/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>

#include "tools/report/in_words.hpp"
#include "tools/report/seconds_since.hpp"

namespace delf {

namespace {
// A stream that takes no more is no reason to end a run.
void say(const std::string& text) { std::fputs(text.c_str(), stderr); }
}  // namespace

Progress::Progress(std::int64_t steps, const char* unit)
    : unit_(unit),
      steps_(std::max<std::int64_t>(1, steps)),
      begin_(Clock::now()),
      last_look_(begin_),
      last_shown_(begin_),
      terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (terminal_ && shown_) std::fputs("\r\033[K", stderr);
}

void Progress::look(std::int64_t step) {
  const auto now = Clock::now();
  const double since = seconds_of(now - last_look_);
  last_look_ = now;
  if (silent) next_look_ = std::numeric_limits<std::int64_t>::max();
  if (silent) return;
  if (since < 0.025) stride_ *= 2;
  if (since > 0.1) stride_ = std::max<std::int64_t>(1, stride_ / 2);
  next_look_ = step + stride_;

  const double elapsed = seconds_of(now - begin_);
  const double left = elapsed * static_cast<double>(steps_ - step) / static_cast<double>(step);
  const double since_shown = seconds_of(now - last_shown_);
  if (terminal_) {
    if (elapsed < 0.5 || (!shown_ && elapsed + left < 2) || since_shown < 0.1) return;
    draw_bar(step, left);
  } else {
    // a line when both 10 s and 10 % have passed, or five minutes
    const bool tenth = step - step_printed_ >= steps_ / 10;
    if (since_shown < 10 || (!tenth && since_shown < 300)) return;
    print_line(step, elapsed, left);
  }
  last_shown_ = now;
  shown_ = true;
}

void Progress::draw_bar(std::int64_t step, double left) const {
  constexpr int width = 40;
  const int full = static_cast<int>(width * step / steps_);
  std::string bar;
  for (int i = 0; i < width; ++i) bar += i < full ? "█" : "░";
  say(fmt::format("\r{} {:3d} %  {} {} of {}  {} left\033[K", bar, 100 * step / steps_, unit_, step, steps_,
                  duration_in_words(left)));
  std::fflush(stderr);
}

void Progress::print_line(std::int64_t step, double elapsed, double left) {
  step_printed_ = step;
  say(fmt::format("{} %: {} {} of {} after {}, {} left\n", 100 * step / steps_, unit_, step, steps_,
                  duration_in_words(elapsed), duration_in_words(left)));
}

}  // namespace delf
