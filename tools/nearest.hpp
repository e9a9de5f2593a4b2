// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace delf {

/// The name that `unknown` was probably meant to be: one that it begins, or else one within a few typing errors
/// (a letter wrong, missing, added, or two of them swapped); an empty string if none is near.
std::string nearest(std::string_view unknown, const std::vector<std::string>& names);

/// "; did you mean NAME?", or "; known: A, B, C" if none is near.
std::string suggestion(std::string_view unknown, const std::vector<std::string>& names);

}  // namespace delf
