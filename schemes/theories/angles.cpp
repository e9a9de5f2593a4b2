// SPDX-License-Identifier: MIT
#include "schemes/theories/angles.hpp"

#include <algorithm>

#include "lattice/text_parts.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

std::vector<int> angles_of(const std::string& name, const FieldTheory& theory, const ParameterValues& values) {
  const bool all = find_theory(name).angle;
  const auto given = values.maybe<std::string>(angles_key);
  const std::vector<std::string> named = given ? parts_of(*given) : std::vector<std::string>();
  std::vector<int> angles;
  for (int field = 0; field < theory.components(); ++field)
    if (all || std::ranges::count(named, theory.fields()[field].name) > 0) angles.push_back(field);
  return angles;
}

}  // namespace delf
