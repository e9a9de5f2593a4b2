// SPDX-License-Identifier: MIT
#pragma once
#include <fmt/format.h>

#include <string>

namespace delf {

/// "17.3 kB", in powers of a thousand; what rounds to 1000 is one of the next.
inline std::string bytes_in_words(double bytes) {
  if (bytes < 1000) return fmt::format("{} B", bytes);
  for (const char* unit : {"kB", "MB", "GB"})
    if ((bytes /= 1000) < 999.5) return fmt::format("{:.3g} {}", bytes, unit);
  return fmt::format("{:.3g} TB", bytes / 1000);
}
inline std::string bytes_in_words(std::size_t bytes) { return bytes_in_words(static_cast<double>(bytes)); }

}  // namespace delf
