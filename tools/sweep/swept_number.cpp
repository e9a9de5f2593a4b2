// SPDX-License-Identifier: MIT
#include "tools/sweep/swept_number.hpp"

#include <charconv>
#include <cmath>

namespace delf {

std::optional<double> swept_number(const std::string& text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

}  // namespace delf
