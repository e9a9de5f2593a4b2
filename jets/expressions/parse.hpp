// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "jets/expressions/graph.hpp"

namespace delf::expressions {

/// The meanings of names in a text, besides functions and pi.
struct Names {
  std::vector<std::pair<std::string, int>> variables;     ///< by number
  std::vector<std::pair<std::string, double>> constants;  ///< parameters
};

/// The text as a node of the graph:
///
///     text       = { "let" name "=" sum ( ";" | end of line ) } sum
///     sum        = product { ( "+" | "-" ) product }
///     product    = signed { ( "*" | "/" ) signed }
///     signed     = { "+" | "-" } power
///     power      = primary [ "^" { "+" | "-" } power ]
///     primary    = number | name | function "(" sum [ "," sum ] ")" | "(" sum ")"
///
/// Throws BadInput for `key`, in one line: the line and the character of what is wrong, the text there, and what was
/// expected. Texts of more than 64 kB, or with brackets more than 200 deep, are refused before they are parsed.
int parse(Graph&, std::string_view text, const Names&, const std::string& key);

/// Throws BadInput for `key` if the text is no name, or one that means something already.
void check_new_name(std::string_view name, const Names&, const std::string& key);

}  // namespace delf::expressions
