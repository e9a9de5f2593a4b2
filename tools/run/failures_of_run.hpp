// SPDX-License-Identifier: MIT
#pragma once
#include <exception>

#include "tools/outcome/outcome.hpp"
#include "tools/report/failure.hpp"

namespace delf {

/// The parts of a run after its first failure, such as a full disk: each is tried, so that what can be written is, and the
/// first failure is what the run ends with.
class FailuresOfRun {
 public:
  explicit FailuresOfRun(Outcome& outcome) : outcome_(outcome) {}

  template <class Part>
  void attempt(const Part& part) {
    try {
      part();
    } catch (const std::exception& error) {
      if (first_) return;
      first_ = std::current_exception();
      if (outcome_.status == "done" && exit_code(error) == ExitCode::system_failed) {
        outcome_.status = "system-failure";
        outcome_.failure = error.what();
      }
    }
  }
  const std::exception_ptr& first() const { return first_; }

 private:
  Outcome& outcome_;
  std::exception_ptr first_;
};

}  // namespace delf
