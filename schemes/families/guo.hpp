// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/families/residual_family.hpp"

namespace delf {

/// The energy-conserving scheme of Guo, Pascual, Rodriguez and Vázquez, Marsden–Patrick–Shkoller (5.15) with the
/// divisions and the "= 0" that its print lacks. No Lagrangian. Vertices: below, left, centre, right, above.
///
///   ∂²_k y_j/k² − ∂²_h y_j/h² + (N(y_{j+1}) − N(y_{j−1}))/(y_{j+1} − y_{j−1}) = 0
inline DirectResidual guo() {
  return {.pattern = StencilPattern({{-1, 0}, {0, -1}, {0, 0}, {0, 1}, {1, 0}}),
          .centre = 2,
          .by_tt = {1, 0, -2, 0, 1},
          .by_xx = {0, 1, -2, 1, 0},
          .by_t = {},
          .quotients = {{4, 0, 1.0}}};
}

}  // namespace delf
