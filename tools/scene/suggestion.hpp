// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace delf {

/// "; did you mean NAME?", or "; known: A, B, C" if none is near.
std::string suggestion(std::string_view unknown, const std::vector<std::string>& names);

}  // namespace delf
