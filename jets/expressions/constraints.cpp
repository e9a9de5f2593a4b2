// SPDX-License-Identifier: MIT
#include "jets/expressions/constraints.hpp"

#include "lattice/text_parts.hpp"

namespace delf {

std::vector<std::string> constraints_of(std::string_view text) {
  std::vector<std::string> constraints;
  if (trimmed(text).empty()) return constraints;
  std::string names;
  for (const std::string& part : parts_of(text, ';'))
    if (part.starts_with("let ")) names += part + "; ";
    else constraints.push_back(names + part);
  if (constraints.empty()) constraints.emplace_back(text);  // definitions alone: the parser says what is missing
  return constraints;
}

}  // namespace delf
