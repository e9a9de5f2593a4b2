// SPDX-License-Identifier: MIT
#pragma once
#include <exception>
#include <string>

#include "lattice/error.hpp"

namespace delf {

/// A scene or a command line that asks for what cannot be. what() is the whole line, with file, line and key in it.
struct BadScene : BadInput {
  explicit BadScene(const std::string& line) : BadInput("", line) {}
};

/// The system failed: disk, memory, a directory that cannot be made.
struct SystemFailure : Error {
  using Error::Error;
};

/// What the program returns. Nothing else in the program chooses a number.
enum class ExitCode {
  done = 0,
  check_failed = 1,
  bad_input = 2,
  numerics_failed = 3,
  system_failed = 4,
  interrupted = 130
};

/// The exit code of whatever was thrown.
ExitCode exit_code(const std::exception&);
/// What summary.json and verify.json call it: not-finite, mesh-crossing or no-convergence.
const char* status_of(const NumericalFailure&);
/// The one line that tells it on stderr.
std::string error_line(const std::exception&);

}  // namespace delf
