// SPDX-License-Identifier: MIT
#include "tools/report/interrupt.hpp"

namespace delf {

volatile std::sig_atomic_t Interrupt::asked_ = 0;

void Interrupt::ask(int) { asked_ = 1; }

Interrupt::Interrupt() {
  asked_ = 0;
  struct sigaction action {};
  sigemptyset(&action.sa_mask);
  action.sa_handler = ask;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;  // no write is cut short
  sigaction(SIGINT, &action, &interrupt_);
  sigaction(SIGTERM, &action, &terminate_);
  sigaction(SIGHUP, &action, &hang_up_);
}

Interrupt::~Interrupt() {
  sigaction(SIGINT, &interrupt_, nullptr);
  sigaction(SIGTERM, &terminate_, nullptr);
  sigaction(SIGHUP, &hang_up_, nullptr);
}

}  // namespace delf
