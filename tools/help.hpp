// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "tools/report/failure.hpp"

namespace delf {

/// The commands, in a few lines.
std::string usage();
/// `delf help`: of one command, or of all if it is empty.
ExitCode help(const std::string& command);

}  // namespace delf
