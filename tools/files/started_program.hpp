// SPDX-License-Identifier: MIT
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace delf {

/// Starts a program, by its name in PATH, in a folder: words[0] with the others, nothing on its standard input, and these
/// descriptors for what it says and complains. Returns 0 and the process, or the error as errno has it.
int start_program(std::vector<std::string> words, const std::filesystem::path& folder, int output, int complaints,
                  pid_t& process);

}  // namespace delf
