// SPDX-License-Identifier: MIT
#include "tools/diagnosis/fields_system.hpp"

#include <algorithm>

#include "lattice/error.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

std::optional<LatticeSystem> fields_system(const Problem& given) {
  try {
    const Problem p = completed(given);
    const auto theory = make_theory(find_theory(p.theory), p.parameters);
    SchemeParts parts = find_method(p.method).build(*theory, p);
    if (!std::ranges::all_of(parts.components, [](const Component& c) { return c.role == Role::field; }))
      return std::nullopt;
    return LatticeSystem(p.lattice, std::move(parts.families), p.time_step, std::move(parts.components));
  } catch (const BadInput&) {
    return std::nullopt;
  }
}

}  // namespace delf
