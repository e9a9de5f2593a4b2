// SPDX-License-Identifier: MIT
#include "tools/scene/suggestion.hpp"

#include <fmt/format.h>

#include "lattice/nearest_name.hpp"

namespace delf {

std::string suggestion(std::string_view unknown, const std::vector<std::string>& names) {
  if (const auto close = nearest(unknown, names)) return fmt::format("; did you mean {}?", *close);
  return fmt::format("; known: {}", fmt::join(names, ", "));
}

}  // namespace delf
