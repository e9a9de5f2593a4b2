// SPDX-License-Identifier: MIT
#pragma once
#include <csignal>

namespace delf {

/// While it lives, SIGINT, SIGTERM and SIGHUP only raise a flag, so that a run can write what it has; the second one ends the
/// program at once.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  static bool asked() noexcept { return asked_ != 0 || asked_here_; }
  /// Asks for the end of the run of this thread alone.
  static void ask_here() noexcept { asked_here_ = true; }
  /// No end is asked for any more: before another run in this thread, and with `all` in any.
  static void forget(bool all) noexcept {
    asked_here_ = false;
    if (all) asked_ = 0;
  }

 private:
  static void ask(int signal);
  static volatile std::sig_atomic_t asked_;
  static inline thread_local bool asked_here_ = false;
  struct sigaction interrupt_, terminate_, hang_up_;
};

}  // namespace delf
