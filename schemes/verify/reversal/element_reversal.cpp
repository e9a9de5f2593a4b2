// SPDX-License-Identifier: MIT
#include "schemes/verify/reversal/element_reversal.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "jets/tables/density_on_table.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {
namespace {

constexpr double rounding = 1e-12;

/// Points at τ and at 1 − τ, at the same place, have the same weight.
bool is_symmetric(const StencilTable& table) {
  return std::ranges::all_of(table.points, [&](const TablePoint& point) {
    return std::ranges::any_of(table.points, [&](const TablePoint& other) {
      return std::abs(point.time + other.time - 1) < rounding && std::abs(point.space - other.space) < rounding &&
             std::abs(point.weight - other.weight) < rounding;
    });
  });
}

/// True if the nodes of a cell that constraints hold, the lower end counted for both, lie at τ and 1 − τ.
bool are_symmetric(const std::vector<double>& times) {
  return std::ranges::all_of(times, [&](double time) {
    return time == 0 || std::ranges::any_of(times, [&](double other) { return std::abs(time + other - 1) < rounding; });
  });
}

}  // namespace

bool reversible_elements(const LatticeSystem& system) {
  std::vector<double> held;
  for (const auto& family : system.families()) {
    if (const DensityOnTable* element = family->made_of()) {
      // ℓ(φ, −φ_t, φ_x, φ_tt, −φ_tx, φ_xx) = ℓ
      if (!element->density->is_even(Reflection::in_time) || !is_symmetric(element->table)) return false;
      continue;
    }
    bool constrains = false;
    for (const auto& value : family->values())
      constrains = constrains || system.component(value.component).role == Role::multiplier;
    if (!constrains) return false;
    for (const auto& value : family->values()) {
      const Component& c = system.component(value.component);
      if (c.role == Role::multiplier && !c.momentum) held.push_back(c.at.time);
    }
  }
  return are_symmetric(held);
}

}  // namespace delf
