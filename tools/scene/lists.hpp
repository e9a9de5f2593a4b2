// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "tools/scene/settings.hpp"

namespace delf {

/// Names that commas separate, but for commas between parentheses: "guo, spacetime (2,2) gauss".
std::vector<std::string> names_in(std::string_view text);
/// Words that commas or blanks separate.
std::vector<std::string> words_in(std::string_view text);
/// The positive numbers of a key; empty if it is not given. Throws BadScene if it is, and has none.
std::vector<double> positive_numbers(const Settings&, std::string_view key);

}  // namespace delf
