// SPDX-License-Identifier: MIT
#include "jets/tables/stencil_table.hpp"

#include <algorithm>
#include <cmath>

#include "lattice/index.hpp"

namespace delf {

bool is_consistent(const StencilTable& table) {
  const auto near = [](double a, double b) { return std::abs(a - b) < 1e-12; };
  const auto& vertices = table.pattern.vertices;
  const auto node = [&](const Site& v) { return table.nodes[v.node]; };
  const auto time = [&](const Site& v) { return v.time + node(v).time; };
  const auto space = [&](const Site& v) { return v.space + node(v).space; };
  // On one point of space there is no φ_x to find.
  const bool wide = std::ranges::any_of(vertices, [&](const Site& v) { return space(v) != space(vertices[0]); });
  double total = 0;
  for (const TablePoint& p : table.points) {
    total += p.weight;
    for (int s = 0; s < jet_slots; ++s) {
      double of_1 = 0, of_t = 0, of_x = 0, of_tt = 0, of_tx = 0, of_xx = 0;
      for (const TablePoint::Entry& e : p.slots[at(s)]) {
        const double t = time(vertices[e.vertex]);
        const double x = space(vertices[e.vertex]);
        of_1 += e.weight, of_t += e.weight * t, of_x += e.weight * x;
        of_tt += e.weight * t * t / 2, of_tx += e.weight * t * x, of_xx += e.weight * x * x / 2;
      }
      const auto slot = static_cast<JetSlot>(s);
      const bool empty = p[slot].empty();
      switch (slot) {
        case JetSlot::phi:
          if (!near(of_1, 1) || !near(of_t, p.time) || !near(of_x, p.space)) return false;
          break;
        case JetSlot::phi_t:
          if (!near(of_1, 0) || !near(of_t, 1) || !near(of_x, 0)) return false;
          break;
        case JetSlot::phi_x:
          if (!near(of_1, 0) || !near(of_t, 0) || !near(of_x, wide ? 1 : 0)) return false;
          break;
        default: {  // second derivatives, where a table has them: exact on quadratic fields
          const double expected[] = {of_tt, of_tx, of_xx};
          for (int c = 0; c < 3 && !empty; ++c)
            if (!near(expected[c], s - static_cast<int>(JetSlot::phi_tt) == c ? 1 : 0)) return false;
          if (!near(of_1, 0) || !near(of_t, 0) || !near(of_x, 0)) return false;
        }
      }
    }
  }
  return near(total, 1);
}

}  // namespace delf
