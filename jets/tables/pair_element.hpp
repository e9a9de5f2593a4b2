// SPDX-License-Identifier: MIT
#pragma once
#include "jets/tables/space_table.hpp"
#include "jets/tables/splitting.hpp"
#include "jets/tables/stencil_table.hpp"
#include "jets/tables/table_product.hpp"
#include "lattice/index.hpp"

namespace delf {

/// One step of a splitting over wide stencils of the weights m² β_m in `pairs`, anchored at a site i: nodes are the rows
/// between the sub-steps. In sub-step s, of the length a_s h, with D_m = (y_{i+m} − y_i)/(mk),
///
///     L = Σ_m m² β_m Σ ½ w ℓ(φ, φ_t, D_m)       over both ends of a pair and both rows of the sub-step,
///
/// where φ, and φ_t = (y_above − y)/(a_s h), are those of the end and D_m that of the row: explicit where ℓ is
/// ½φ_t² plus a function of φ and φ_x. Any density: each of the pairs alone is the average of ℓ over its two ends.
///
///     row 1      ○ ○ ○      p = 2. The unit cell has S nodes, one above the other: ● the vertex, ∘ between sub-steps.
///     nodes      ∘ ○ ○
///     row 0      ● ○ ○
///
inline StencilTable pair_element(const Splitting& splitting, const std::vector<double>& pairs) {
  return product(splitting_element(splitting), pair_space(pairs));
}

inline StencilTable pair_element(const Splitting& splitting, int p) { return pair_element(splitting, pair_weights(p)); }

/// The force at every site of row 0, for densities with φ_xx: φ there, and over pairs up to q apart
///
///     φ_xx = Σ_m m² β_m (y_{i+m} − 2y_i + y_{i−m})/(mk)²
///
inline StencilTable force_table(int q, double offset = 0) {
  StencilTable table{.pattern = {}, .points = {}};
  for (int m = -q; m <= q; ++m) table.pattern.vertices.push_back({.time = 0, .space = m});
  std::vector phi(at(2 * q + 1), 0.0), phi_xx = phi;
  const std::size_t centre = q;
  const std::vector<double> pairs = pair_weights(q);
  phi[centre] = 1;
  for (std::size_t m = 1; m <= centre; ++m) {
    const double weight = pairs[m - 1] / static_cast<double>(m * m);
    phi_xx[centre + m] += weight, phi_xx[centre - m] += weight, phi_xx[centre] -= 2 * weight;
  }
  TablePoint point{.weight = 1, .time = offset, .space = 0, .slots = {}};
  point.set(JetSlot::phi, phi), point.set(JetSlot::phi_xx, phi_xx);
  table.points.push_back(std::move(point));
  return table;
}

}  // namespace delf
