// SPDX-License-Identifier: MIT
#include "schemes/system/slab_extent.hpp"

#include <algorithm>

namespace delf {

SlabExtent slab_extent(const LatticeSystem& system, const SolvePlan& plan) {
  SlabExtent extent;
  extent.history = plan.history;
  extent.behind.assign(system.components(), 0);
  for (int parity = 0; parity < plan.table.parities; ++parity) {
    const Slab slab = plan.slab(parity);
    for (const Node& unknown : slab.unknowns) {
      const int offset = unknown.site.time - parity;
      extent.below = std::max(extent.below, -offset);
      extent.above = std::max(extent.above, offset);
      if (system.component(unknown.component).role == Role::field)
        extent.field_lag = std::max(extent.field_lag, -offset);
      int& behind = extent.behind[unknown.component];
      behind = std::max(behind, -offset);
    }
    for (const Node& equation : slab.equations) {
      extent.equation_lag = std::max(extent.equation_lag, parity - equation.site.time);
      extent.equation_lead = std::max(extent.equation_lead, equation.site.time - parity);
    }
  }
  for (int c = 0; c < system.components(); ++c) {
    int& behind = extent.behind[c];
    behind = system.component(c).role == Role::field ? 0 : std::max(0, behind - extent.field_lag);
  }
  return extent;
}

}  // namespace delf
