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

  static bool asked() noexcept { return asked_ != 0; }

 private:
  static void ask(int signal);
  static volatile std::sig_atomic_t asked_;
  struct sigaction interrupt_, terminate_, hang_up_;
};

}  // namespace delf
