// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace delf {

/// The text without the white space around it.
std::string trimmed(std::string_view);
/// The parts between separators, each trimmed: one more than there are separators, so an empty text has one part.
std::vector<std::string> parts_of(std::string_view text, char separator = ',');

}  // namespace delf
