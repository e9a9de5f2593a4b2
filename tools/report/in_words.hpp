// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "schemes/stepping/bytes_in_words.hpp"

namespace delf {

/// "0.31 s", "42 s", "3 min 10 s", "5 h 2 min"
std::string duration_in_words(double seconds);
/// "1.94 ns per site and step"
std::string cost_in_words(double ns);

}  // namespace delf
