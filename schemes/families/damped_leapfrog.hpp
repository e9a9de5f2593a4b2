// SPDX-License-Identifier: MIT
#pragma once
#include <array>

#include "lattice/stencil_shape.hpp"

namespace delf {

/// Leapfrog with friction: a dissipative scheme without a Lagrangian, for checks to be seen to fail on.
///
///   ∂²_h y/h² − ∂²_k y/k² − N′(y_j) + γ (y_{j+1} − y_{j−1})/2h = 0
template <class Theory>
struct DampedLeapfrog {
  static constexpr double friction = 0.1;  ///< γ

  /// below, left, centre, right, above
  static constexpr Offsets<5> shape{{{{-1, 0}, {0, -1}, {0, 0}, {0, 1}, {1, 0}}}};
  static constexpr int centre = 2;
  static constexpr std::array<double, 5> by_tt{1, 0, -2, 0, 1};
  static constexpr std::array<double, 5> by_xx{0, 1, -2, 1, 0};
  static constexpr std::array<bool, 5> nonlinear_in{true, false, true, false, true};

  Theory theory;
  double time_step;

  template <class T>
  T nonlinear(const std::array<T, 5>& y) const {
    return theory.difference_quotient(y[2], y[2]) - (0.5 * friction / time_step) * (y[4] - y[0]);
  }
};

}  // namespace delf
