// SPDX-License-Identifier: MIT
#pragma once
#include <string>

namespace delf {

/// "0.31 s", "42 s", "3 min 10 s", "5 h 2 min"
std::string duration_in_words(double seconds);
/// "1.94 ns per site and step"
std::string cost_in_words(double ns);
/// "512 B", "1.9 MB"
std::string bytes_in_words(double bytes);

}  // namespace delf
