// SPDX-License-Identifier: MIT
#include "tools/interrupt.hpp"

namespace delf {

volatile std::sig_atomic_t Interrupt::asked_ = 0;

void Interrupt::ask(int) { asked_ = 1; }

Interrupt::Interrupt() {
  asked_ = 0;
  struct sigaction action {};
  sigemptyset(&action.sa_mask);
  action.sa_handler = ask;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;  // a full disk or a slow pipe is not cut short
  sigaction(SIGINT, &action, &interrupt_);
  sigaction(SIGTERM, &action, &terminate_);
  action.sa_handler = SIG_IGN;
  action.sa_flags = 0;
  sigaction(SIGXFSZ, &action, &file_size_);
}

Interrupt::~Interrupt() {
  sigaction(SIGINT, &interrupt_, nullptr);
  sigaction(SIGTERM, &terminate_, nullptr);
  sigaction(SIGXFSZ, &file_size_, nullptr);
}

}  // namespace delf
