// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>

namespace delf {

/// A value of a swept key as a number; empty for words and for what is not finite.
std::optional<double> swept_number(const std::string&);

}  // namespace delf
