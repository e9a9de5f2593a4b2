// SPDX-License-Identifier: MIT
#include "schemes/theories/theory_on_space.hpp"

#include <algorithm>
#include <string>

#include "lattice/error.hpp"

namespace delf {

std::vector<Component> multipliers_of(const FieldTheory& theory) {
  std::vector<Component> list;
  const auto constraint = theory.constraint();
  const int count = constraint ? constraint->size() - theory.components() : 0;
  for (int m = 0; m < count; ++m)
    list.push_back({count == 1 ? "lambda" : "lambda" + std::to_string(m + 1), Role::multiplier, {}});
  return list;
}

void require_theory_on(const FieldTheory& theory, Space space) {
  if (space != Space::point && std::ranges::count(theory.fields(), "x", &Component::name) > 0)
    throw BadInput("theory.fields",
                   "theory.fields: \"x\" is the place in densities, but on lattice.space = point; choose another name");
}

}  // namespace delf
