// SPDX-License-Identifier: MIT
#include "schemes/verify/element_reversal.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "jets/simd/pack.hpp"
#include "schemes/families/jet_family.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {
namespace {

constexpr double rounding = 1e-12;

/// ℓ(φ, −φ_t, φ_x, φ_tt, −φ_tx, φ_xx) = ℓ at random jets.
bool is_even_in_rates(const BatchDensity& density) {
  const int d = density.components(), slots = density.variables() / d;
  std::mt19937_64 random(20261126);
  constexpr int jets = 8;
  for (int n = 0; n < jets; ++n) {
    std::uniform_real_distribution<double> uniform(n % 2 ? -1 : 0.1, n % 2 ? 1 : 2);
    std::vector<Pack> jet, mirrored;
    for (int v = 0; v < density.variables(); ++v) {
      const auto slot = static_cast<JetSlot>(v / d);
      jet.emplace_back(uniform(random));
      mirrored.push_back(slot == JetSlot::phi_t || slot == JetSlot::phi_tx ? -jet.back() : jet.back());
    }
    const auto value = [&](const std::vector<Pack>& at) {
      std::vector<const double*> rows;
      for (const Pack& pack : at) rows.push_back(reinterpret_cast<const double*>(&pack));
      const Pack x(0.0);
      Pack l;
      density.value({lanes, rows.data(), 0, reinterpret_cast<const double*>(&x)}, reinterpret_cast<double*>(&l));
      return l[0];
    };
    const double one = value(jet), other = value(mirrored);
    if (std::isfinite(one) && !(std::abs(one - other) <= rounding * (1 + std::abs(one)))) return false;
  }
  return slots > 0;
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

/// Whether the nodes of a cell that constraints hold, the lower end counted for both, lie at τ and 1 − τ.
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
      if (element->is_placed() || !is_even_in_rates(element->density()) || !is_symmetric(element->table()))
        return false;
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
