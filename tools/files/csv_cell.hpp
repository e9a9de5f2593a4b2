// SPDX-License-Identifier: MIT
#pragma once
#include <string>

namespace delf {

/// A text as a table of comma-separated values has it: in quotes where it holds a comma, a quote or a line break.
inline std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace delf
