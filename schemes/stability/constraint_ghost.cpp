// SPDX-License-Identifier: MIT
#include "schemes/stability/constraint_ghost.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numbers>
#include <vector>

#include "lattice/error.hpp"
#include "schemes/stability/symbol.hpp"

namespace delf {
namespace {

/// The families that read no multiplier; none if there are other components than fields besides.
std::vector<std::shared_ptr<const StencilFamily>> without_constraints(const LatticeSystem& system) {
  const auto role = [&](int c) { return system.component(c).role; };
  for (int c = 0; c < system.components(); ++c)
    if (role(c) != (c < system.fields() ? Role::field : Role::multiplier)) return {};
  std::vector<std::shared_ptr<const StencilFamily>> families;
  if (system.fields() == system.components()) return families;
  for (const auto& family : system.families())
    if (std::ranges::none_of(family->values(), [&](auto& v) { return role(v.component) == Role::multiplier; }))
      families.push_back(family);
  return families;
}

}  // namespace

std::optional<ConstraintGhost> ghost_under_constraint(const LatticeSystem& system) {
  const auto families = without_constraints(system);
  if (families.empty() || system.lattice().space() == Space::mesh) return std::nullopt;
  try {
    // At a stability limit a root is −1 as well, but not below it.
    const Symbol symbol(LatticeSystem(system.lattice(), families, system.time_step()));
    const Symbol shorter(LatticeSystem(system.lattice(), families, 0.7 * system.time_step()));
    const bool point = system.lattice().space() == Space::point;  // it has no neighbours, and no waves but θ = 0
    for (const double theta : {std::numbers::pi, 0.0})
      for (const int z : {-1, 1}) {
        if (point && theta != 0) continue;
        // Bricks have two names for a wave, (z, θ) and (−z, θ + π).
        const bool is_constant = (theta == 0 && z == 1) || (symbol.brick() && theta != 0 && z == -1);
        if (!is_constant && symbol.is_root(z, theta) && shorter.is_root(z, theta)) return ConstraintGhost{theta, z};
      }
  } catch (const BadInput&) {  // no symbol: a placed density, or one that is not defined at zero
  }
  return std::nullopt;
}

std::string in_words_under_constraint(const ConstraintGhost& ghost) {
  return fmt::format(
      "waves near theta = {}, z = {} off the constraint's surface grow from rounding, and faster for a shorter time "
      "step",
      ghost.theta == 0 ? "0" : "pi", ghost.z);
}

}  // namespace delf
