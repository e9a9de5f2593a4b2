// SPDX-License-Identifier: MIT
#include "schemes/unknown_name.hpp"

#include <fmt/format.h>

#include "lattice/nearest_name.hpp"

namespace delf {

BadInput unknown_name(const std::string& key, const std::string& value, const std::vector<std::string>& names) {
  const auto near = nearest(value, names);
  return {key,
          fmt::format("{} = {}: there is no such {}{}; choose one of {}", key, value, key.substr(key.find('.') + 1),
                      near ? fmt::format(" (did you mean {}?)", *near) : "", fmt::join(names, ", "))};
}

}  // namespace delf
