// SPDX-License-Identifier: MIT
#include "schemes/system/time_derivative.hpp"

#include <algorithm>

#include "jets/field_motion.hpp"
#include "lattice/error.hpp"
#include "schemes/families/jet_family.hpp"

namespace delf {
namespace {

/// Null for families that are not made of a density.
const BatchDensity* density_of(const StencilFamily& family) {
  const auto* jets = dynamic_cast<const JetFamily*>(&family);
  return jets ? &jets->density() : nullptr;
}

}  // namespace

void require_time_derivative(const LatticeSystem& system) {
  int d = 0;
  for (const auto& family : system.families()) {
    if (const BatchDensity* density = density_of(*family)) d = std::max(d, density->components());
    // Other families that reach from row to row may be the kinetic term: nothing is proved of them.
    else if (!std::ranges::all_of(family->pattern().vertices, [](const Site& v) { return v.time == 0; })) return;
  }
  FieldMotion fields(d);
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
