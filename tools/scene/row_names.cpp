// SPDX-License-Identifier: MIT
#include "tools/scene/row_names.hpp"

#include <algorithm>

namespace delf {

RowNames::RowNames(const Simulation& simulation) : field() {
  for (const Component& c : simulation.components()) {
    if (c.position) mesh = field.size();
    (c.role == Role::field ? field : c.role == Role::inner ? inner : multiplier).push_back(c.name);
  }
  if (!multiplier.empty()) further.emplace_back("constraint");
  further.insert(further.end(), simulation.conserved_names().begin(), simulation.conserved_names().end());
}

}  // namespace delf
