// SPDX-License-Identifier: MIT
#include "tools/files/row_names.hpp"

#include <algorithm>

namespace delf {

RowNames::RowNames(const Simulation& simulation) : of() {
  for (const Component& c : simulation.components()) {
    if (c.position && !mesh) mesh = {c.role, of[c.role].size()};
    of[c.role].push_back(c.name);
  }
  datasets = simulation.datasets();
  if (!of[Role::multiplier].empty()) further.emplace_back("constraint");
  const std::vector<std::string> of_method = simulation.monitor_names();
  further.insert(further.end(), of_method.begin(), of_method.end());
  further.insert(further.end(), simulation.conserved_names().begin(), simulation.conserved_names().end());
}

std::vector<std::string> RowNames::drawn() const {
  std::vector<std::string> names = of[Role::field];
  if (mesh && mesh->role != Role::field) names.push_back(of[mesh->role][mesh->index]);
  return names;
}

std::optional<std::size_t> RowNames::drawn_mesh() const {
  if (!mesh) return std::nullopt;
  return mesh->role == Role::field ? mesh->index : of[Role::field].size();
}

bool RowNames::plain() const {
  return of[Role::field].size() == 1 &&
         std::ranges::all_of(all_roles, [&](Role role) { return role == Role::field || of[role].empty(); });
}

}  // namespace delf
