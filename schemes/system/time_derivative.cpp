// SPDX-License-Identifier: MIT
#include "schemes/system/time_derivative.hpp"

#include <algorithm>

#include "jets/field_motion.hpp"
#include "jets/tables/density_on_table.hpp"
#include "lattice/error.hpp"

namespace delf {

void require_time_derivative(const LatticeSystem& system) {
  int d = 0;
  for (const auto& family : system.families()) {
    if (const DensityOnTable* jets = family->made_of()) d = std::max(d, jets->density->components());
    // Other families that reach from row to row may be the kinetic term: nothing is proved of them.
    else if (!std::ranges::all_of(family->pattern().vertices, [](const Site& v) { return v.time == 0; })) return;
  }
  FieldMotion fields(d);
  for (const auto& family : system.families())
    if (const DensityOnTable* jets = family->made_of()) fields.add(*jets->density);
  fields.spread();
  for (int a = 0; a < d; ++a) {
    if (!fields.present[a] || fields.moving[a]) continue;
    const std::string name = d == 1 ? "phi" : "phi" + std::to_string(a + 1);
    throw BadInput("theory.name", "the density has no kinetic term for " + name +
                                      ": no row determines the next; add one, "
                                      "such as 0.5 " +
                                      name + "_t^2");
  }
}

}  // namespace delf
