// SPDX-License-Identifier: MIT
#include "schemes/system/jet_slots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "jets/tables/density_on_table.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"

namespace delf {

void require_jet_slots(const LatticeSystem& system) {
  // terms of walls are of the same density, and see fewer slots
  std::map<const BatchDensity*, std::array<bool, jet_slots>> seen;
  for (const auto& family : system.families())
    if (const DensityOnTable* jets = family->made_of())
      for (const TablePoint& point : jets->table.points)
        for (std::size_t s = 0; s < point.slots.size(); ++s)
          seen[jets->density.get()][s] = seen[jets->density.get()][s] || !point.slots[s].empty();
  for (const auto& [density, slots] : seen)
    for (int v = 0; v < density->variables(); ++v) {
      const std::size_t s = v / density->components();
      if (s == at(JetSlot::phi_x)) continue;  // on a point it is 0; wider stencils have it
      if (density->depends_on(v) && !slots[s])
        throw BadInput("theory.name",
                       fmt::format("the density has {}, and the stencils of this scheme have no jet with it: the term "
                                   "would be left out; remove it, or use a stencil that has it (`delf help "
                                   "lagrangians`)",
                                   slot_names[s]));
    }
}

}  // namespace delf
