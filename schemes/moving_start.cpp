// SPDX-License-Identifier: MIT
#include "schemes/moving_start.hpp"

#include <cstddef>
#include <vector>

#include "schemes/methods/method_registry.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {

bool starts_by_sites(const Simulation& simulation, const Problem& problem) {
  return find_method(problem.method).place_sites && simulation.evolution().system().moves();
}

void start_by_sites(Simulation& simulation, const Problem& given, const StartField& profile) {
  const Problem problem = completed(given);
  const int fields = simulation.theory().components();
  const MovingSites sites = find_method(problem.method).place_sites(problem, fields, profile);
  const std::vector<Component>& components = simulation.components();
  const std::size_t C = components.size();
  std::vector<double> row(sites.X.size() * C, 0.0), rates = row;
  std::vector<FieldPoint> field(fields);
  for (std::size_t i = 0; i < sites.X.size(); ++i) {
    profile(sites.X[i], field);
    for (std::size_t c = 0; c < C; ++c) {
      const Component& component = components[c];
      const std::size_t at = i * C + c;
      const bool of_field = component.role == Role::field || component.role == Role::inner;
      if (component.position || (of_field && component.field == fields)) {
        row[at] = sites.X[i], rates[at] = sites.X_t[i];
      } else if (of_field) {
        const FieldPoint& f = field[component.field];
        row[at] = f.phi, rates[at] = f.phi_t + f.phi_x * sites.X_t[i];
      }
    }
  }
  simulation.start_legendre(row, rates);
}

}  // namespace delf
