// SPDX-License-Identifier: MIT
#include "tools/report/in_words.hpp"

#include <fmt/format.h>

#include <cmath>

namespace delf {

std::string duration_in_words(double seconds) {
  if (!(seconds < 1e9)) return "very long";
  if (seconds < 0.0995) return fmt::format("{:.2g} ms", 1e3 * seconds);
  if (seconds < 10) return fmt::format("{:.2g} s", seconds);
  const auto whole = std::llround(seconds);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

std::string cost_in_words(double ns) {
  return ns < 999.5 ? fmt::format("{:.3g} ns per site and step", ns) : fmt::format("{:.0f} ns per site and step", ns);
}

}  // namespace delf
