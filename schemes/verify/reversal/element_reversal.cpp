// SPDX-License-Identifier: MIT
#include "schemes/verify/reversal/element_reversal.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "jets/simd/scratch_rows.hpp"
#include "schemes/families/jet_family.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {
namespace {

constexpr double rounding = 1e-12;

/// At some t and x, ℓ(φ, −φ_t, φ_x, φ_tt, −φ_tx, φ_xx) = ℓ at random jets: half of them from −1 to 1, half of them where logarithms and roots
/// have values.
bool is_even_in_rates(const BatchDensity& density) {
  constexpr int jets = 2 * lanes;
  const int m = density.variables();
  ScratchRows jet(m + 1, jets), l(2, jets);
  std::mt19937_64 random(20261126);
  for (int v = 0; v < m; ++v)
    for (int n = 0; n < jets; ++n)
      jet[v][n] = std::uniform_real_distribution<double>(n % 2 ? -1 : 0.1, n % 2 ? 1 : 2)(random);
  for (int n = 0; n < jets; ++n) jet[m][n] = std::uniform_real_distribution<double>(0, 1)(random);
  const JetBatch batch{jets, jet.data(), std::uniform_real_distribution<double>(0, 1)(random), jet[m]};
  density.value(batch, l[0]);
  for (int v = 0; v < m; ++v)
    if (const auto slot = static_cast<JetSlot>(v / density.components());
        slot == JetSlot::phi_t || slot == JetSlot::phi_tx)
      for (int n = 0; n < jets; ++n) jet[v][n] = -jet[v][n];
  density.value(batch, l[1]);
  for (int n = 0; n < jets; ++n)
    if (std::isfinite(l[0][n]) && !(std::abs(l[0][n] - l[1][n]) <= rounding * (1 + std::abs(l[0][n])))) return false;
  return true;
}

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
    if (const auto* element = dynamic_cast<const JetFamily*>(family.get())) {
      if (!is_even_in_rates(element->density()) || !is_symmetric(element->table())) return false;
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
