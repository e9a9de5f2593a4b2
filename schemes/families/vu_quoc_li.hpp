// SPDX-License-Identifier: MIT
#pragma once
#include "lattice/shapes/nine_tuple.hpp"
#include "schemes/families/residual_family.hpp"

namespace delf {

/// The energy-conserving scheme of Vu-Quoc and Li, Marsden–Patrick–Shkoller (5.14), over the nine-tuple: no Lagrangian.
///
///   (¼∂²_k y_{j+1} + ½∂²_k y_j + ¼∂²_k y_{j−1})/k² − ∂²_h y/h² + ½(Q(y_{j+1}, y_j) + Q(y_j, y_{j−1})) = 0,
///   Q(a, b) = (N(a) − N(b))/(a − b)
inline DirectResidual vu_quoc_li() {
  return {.pattern = StencilPattern(shapes::nine_tuple),
          .centre = 4,
          .by_tt = {0, 1, 0, 0, -2, 0, 0, 1, 0},
          .by_xx = {.25, -.5, .25, .5, -1, .5, .25, -.5, .25},
          .by_t = {},
          .quotients = {{7, 4, 0.5}, {4, 1, 0.5}}};
}

}  // namespace delf
