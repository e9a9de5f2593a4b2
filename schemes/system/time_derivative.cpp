// SPDX-License-Identifier: MIT
#include "schemes/system/time_derivative.hpp"

#include <algorithm>

#include "lattice/error.hpp"
#include "schemes/families/jet_family.hpp"

namespace delf {
namespace {

/// Null for families that are not made of a density.
const BatchDensity* density_of(const StencilFamily& family) {
  const auto* jets = dynamic_cast<const JetFamily*>(&family);
  return jets ? &jets->density() : nullptr;
}

bool is_of_time(JetSlot slot) { return slot_powers[static_cast<std::size_t>(slot)].time > 0; }

/// What densities add together prove of the fields: which are coupled, and which have derivatives in time.
struct Fields {
  std::vector<bool> present, moving;
  std::vector<std::vector<bool>> coupled;

  explicit Fields(int d) : present(static_cast<std::size_t>(d)), moving(present), coupled(present.size(), present) {}

  // ∂²ℓ/∂(slot of a)∂(slot of b) ≠ 0 is the coefficient of a term of the field equations
  void add(const BatchDensity& density) {
    const int d = density.components();
    for (int v = 0; v < density.variables(); ++v)
      for (int u = 0; u < density.variables(); ++u) {
        if (density.is_zero(v, u)) continue;
        const auto a = static_cast<std::size_t>(v % d), b = static_cast<std::size_t>(u % d);
        present[a] = coupled[a][b] = true;
        if (is_of_time(static_cast<JetSlot>(v / d))) moving[a] = true;
      }
  }
  /// A field that is coupled to one that moves is determined with it: a constraint's multiplier, say.
  void spread() {
    for (std::size_t round = 0; round < moving.size(); ++round)
      for (std::size_t a = 0; a < moving.size(); ++a)
        for (std::size_t b = 0; b < moving.size(); ++b)
          if (coupled[a][b] && moving[b]) moving[a] = true;
  }
};

}  // namespace

void require_time_derivative(const LatticeSystem& system) {
  int d = 0;
  for (const auto& family : system.families()) {
    if (const BatchDensity* density = density_of(*family)) d = std::max(d, density->components());
    // Of other families that reach from row to row nothing is proved: they may be the kinetic term.
    else if (!std::ranges::all_of(family->pattern().vertices, [](const Site& v) { return v.time == 0; })) return;
  }
  Fields fields(d);
  for (const auto& family : system.families())
    if (const BatchDensity* density = density_of(*family)) fields.add(*density);
  fields.spread();
  for (int a = 0; a < d; ++a) {
    if (!fields.present[static_cast<std::size_t>(a)] || fields.moving[static_cast<std::size_t>(a)]) continue;
    const std::string name = d == 1 ? "phi" : "phi" + std::to_string(a + 1);
    throw BadInput("theory.name", "the density has no kinetic term for " + name +
                                      ": no row determines the next; add one, "
                                      "such as 0.5 " +
                                      name + "_t^2");
  }
}

}  // namespace delf
