// SPDX-License-Identifier: MIT
#pragma once
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace delf {

/// A program of another package, and how it is waited for.
struct AwaitedProgram {
  std::vector<std::string> words;  ///< its name, and its arguments
  std::string cannot;              ///< "could not draw": what it says then is in parentheses behind it
  std::string if_missing;          ///< the line where it is not installed
  std::chrono::milliseconds limit;
  bool ends_with_us = false;  ///< it is ended when an end of this program is asked for (Interrupt)
};

/// Runs it in `folder`, in which it leaves a file `complaints`. Returns an empty string if it went well, or else one line.
std::string run_program(const AwaitedProgram&, const std::filesystem::path& folder);

/// True if PATH has a program of that name.
bool is_installed(const std::string& program);

}  // namespace delf
