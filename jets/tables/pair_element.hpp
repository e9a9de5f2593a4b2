// SPDX-License-Identifier: MIT
#pragma once
#include "jets/tables/space_table.hpp"
#include "jets/tables/splitting.hpp"
#include "jets/tables/stencil_table.hpp"
#include "jets/tables/table_product.hpp"

namespace delf {

/// One step of a splitting over wide stencils, anchored at a site i: nodes are the rows between the sub-steps. In
/// sub-step s, of the length a_s h, with D_m = (y_{i+m} − y_i)/(mk),
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
inline StencilTable pair_element(const Splitting& splitting, int p) {
  return product(splitting_element(splitting), pair_space(p));
}

}  // namespace delf
