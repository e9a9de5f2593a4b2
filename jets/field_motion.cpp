// SPDX-License-Identifier: MIT
#include "jets/field_motion.hpp"

#include "jets/tables/stencil_table.hpp"
#include "lattice/index.hpp"

namespace delf {

// ∂²ℓ/∂(slot of a)∂(slot of b) ≠ 0 is the coefficient of a term of the field equations
void FieldMotion::add(const BatchDensity& density) {
  const int d = density.components();
  for (int v = 0; v < density.variables(); ++v)
    for (int u = 0; u < density.variables(); ++u) {
      if (density.is_zero(v, u)) continue;
      const std::size_t a = v % d, b = at(u % d);
      present[a] = coupled[a][b] = true;
      if (slot_powers[at(v / d)].time == 0) continue;
      moving[a] = true;
      if (a != b) moving[b] = true;  // in p q_t the equation of q has p_t
    }
}

void FieldMotion::spread() {
  for (std::size_t round = 0; round < moving.size(); ++round)
    for (std::size_t a = 0; a < moving.size(); ++a)
      for (std::size_t b = 0; b < moving.size(); ++b)
        if (coupled[a][b] && moving[b]) moving[a] = true;
}

}  // namespace delf
