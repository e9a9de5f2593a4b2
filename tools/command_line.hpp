// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "tools/failure.hpp"

namespace delf {

/// The program: takes the words after its name, does what they say, tells errors on stderr, returns what main returns.
ExitCode run_program(const std::vector<std::string>& words);

}  // namespace delf
