// SPDX-License-Identifier: MIT
#include "schemes/stability/constraint_ghost.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lattice/error.hpp"

namespace delf {
namespace {

/// "pi", or a number.
std::string angle(double value) {
  const double share = std::abs(value) / std::numbers::pi;
  if (share < 1e-6) return "0";
  return std::abs(share - 1) < 1e-6 ? "pi" : fmt::format("{:.4g}", std::abs(value));
}

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

std::optional<Ghost> ghost_under_constraint(const LatticeSystem& system) {
  const auto families = without_constraints(system);
  if (families.empty()) return std::nullopt;
  const auto at = [&](double time_step) {
    try {
      return linear_stability(LatticeSystem(system.lattice(), families, time_step)).ghosts;
    } catch (const BadInput&) {  // no symbol: a placed density, or one that is not defined at zero
      return std::vector<Ghost>();
    }
  };
  // At a stability limit two roots meet as well, but not below it.
  const std::vector<Ghost> shorter = at(0.7 * system.time_step());
  for (const Ghost& ghost : at(system.time_step()))
    if (std::ranges::any_of(shorter, [&](const Ghost& other) {
          return std::abs(other.theta - ghost.theta) < 1e-4 && std::abs(other.z - ghost.z) < 1e-3;
        }))
      return ghost;
  return std::nullopt;
}

std::string in_words_under_constraint(const Ghost& ghost) {
  const double turn = std::abs(std::arg(ghost.z));
  const std::string z = turn < 1e-6                      ? "1"
                        : std::numbers::pi - turn < 1e-6 ? "-1"
                                                         : fmt::format("exp({}i)", angle(turn));
  return fmt::format(
      "waves near theta = {}, z = {} off the constraint's surface grow from rounding, and faster for a shorter time "
      "step",
      angle(ghost.theta), z);
}

}  // namespace delf
