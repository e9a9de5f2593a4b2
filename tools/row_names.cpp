// SPDX-License-Identifier: MIT
#include "tools/row_names.hpp"

#include <algorithm>

namespace delf {

RowNames::RowNames(const Simulation& simulation) : field() {
  for (const Component& c : simulation.components())
    (c.role == Role::field ? field : c.role == Role::inner ? inner : multiplier).push_back(c.name);
  if (const auto at = std::find(field.begin(), field.end(), "X"); at != field.end() && !multiplier.empty())
    mesh = static_cast<std::size_t>(at - field.begin());
  if (!multiplier.empty()) further.emplace_back("constraint");
  further.insert(further.end(), simulation.conserved_names().begin(), simulation.conserved_names().end());
}

}  // namespace delf
