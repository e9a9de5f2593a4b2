// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace delf {

/// The known name that `name` was probably meant to be: one that it begins, or else the one with the fewest typing
/// errors (a letter wrong, missing, added, or two of them swapped; case and _ for - are none), the first of equals;
/// nothing when even that one needs more than 1 + |name|/3 of them.
std::optional<std::string> nearest(std::string_view name, const std::vector<std::string>& known);

}  // namespace delf
