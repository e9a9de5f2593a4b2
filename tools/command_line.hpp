// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "tools/report/failure.hpp"

namespace delf {

/// The program: takes its command line without the program's name, reports errors on stderr, returns the exit code.
ExitCode run_program(const std::vector<std::string>& words);

}  // namespace delf
