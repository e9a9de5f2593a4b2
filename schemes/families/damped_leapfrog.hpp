// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/families/residual_family.hpp"

namespace delf {

/// Leapfrog with friction γ: a dissipative scheme without a Lagrangian, for checks to be seen to fail on. Vertices: below,
/// left, centre, right, above.
///
///   ∂²_k y/k² − ∂²_h y/h² + N′(y_j) − γ (y_{j+1} − y_{j−1})/2h = 0
inline DirectResidual damped_leapfrog(double friction = 0.1) {
  return {.pattern = StencilPattern({{-1, 0}, {0, -1}, {0, 0}, {0, 1}, {1, 0}}),
          .centre = 2,
          .by_tt = {1, 0, -2, 0, 1},
          .by_xx = {0, 1, -2, 1, 0},
          .by_t = {friction / 2, 0, 0, 0, -friction / 2},
          .quotients = {{2, 2, 1.0}}};
}

}  // namespace delf
