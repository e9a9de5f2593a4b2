// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <vector>

#include "jets/tables/stencil_table.hpp"

namespace delf {

/// The image of a field beyond a wall: odd about the wall's own value, y_{−j} = 2y₀ − y_j, whether it is fixed or not;
/// or even, y_{−j} = y_j − 2jks, where its slope φ_x = s at the wall is kept or, with s = 0, natural.
enum class Mirror { odd, even };

struct MirrorTable {
  StencilTable table;
  /// [point][slot]: what a slope s adds to a slot, as the weights do: times ks, with the slot's own powers of h and k.
  std::vector<std::array<double, jet_slots>> of_slope;
};

/// The action of a wide table, without nodes inside its cells, at a wall, in one stencil with the placement `wall`:
/// a mirror, or a wall. A field that goes on beyond its walls as its mirror image is one on a circle of 2(N − 1) sites, and half
/// of the circle's action is a function of the sites of the interval,
///
///     S = Σ_{points within} w ℓ + ½ Σ_{points whose stencil crosses a wall} w ℓ,
///
/// since points beyond are the mirror images of those within. A point that crosses from beyond is evaluated at its own mirror
/// image: what the density has to be even for is φ ↦ 2φ_wall − φ (odd), and φ_x ↦ −φ_x. The rows of the interval are then those of
/// the circle, to the last bit where sums are taken alike. Points of stencils that are not whole, but within, are in the table too.
MirrorTable mirror_table(const StencilTable&, Placement wall, Mirror);

}  // namespace delf
