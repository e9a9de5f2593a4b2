// SPDX-License-Identifier: MIT
#pragma once
#include <exception>
#include <string>

#include "lattice/error.hpp"

namespace delf {

/// A scene or a command line that cannot be met. what() is the whole line, with file, line and key.
struct BadScene : BadInput {
  explicit BadScene(const std::string& line) : BadInput("", line) {}
};

/// The system failed: disk, memory, a directory that cannot be made.
struct SystemFailure : Error {
  using Error::Error;
};

/// The exit codes. Nothing else in the program chooses one.
enum class ExitCode {
  done = 0,
  check_failed = 1,
  bad_input = 2,
  numerics_failed = 3,
  system_failed = 4,
  interrupted = 130
};

/// The exit code of an exception.
ExitCode exit_code(const std::exception&);
/// Its name in summary.json and verify.json: not-finite, mesh-crossing or no-convergence.
const char* status_of(const NumericalFailure&);
/// The one line for stderr.
std::string error_line(const std::exception&);

}  // namespace delf
