// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace delf {

/// The constraints of a text, separated by semicolons, each with the names that `let` defines before it; none of an empty
/// text.
std::vector<std::string> constraints_of(std::string_view text);

}  // namespace delf
