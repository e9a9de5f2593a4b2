// SPDX-License-Identifier: MIT
#pragma once
#include <array>

#include "lattice/stencil_shape.hpp"

namespace delf {

/// The energy-conserving scheme of Guo, Pascual, Rodriguez and Vázquez, Marsden–Patrick–Shkoller (5.15) with the
/// divisions and the "= 0" that its print lacks. No Lagrangian.
///
///   ∂²_k y_j/k² − ∂²_h y_j/h² + (N(y_{j+1}) − N(y_{j−1}))/(y_{j+1} − y_{j−1}) = 0
template <class Theory>
struct Guo {
  /// below, left, centre, right, above
  static constexpr Offsets<5> shape{{{{-1, 0}, {0, -1}, {0, 0}, {0, 1}, {1, 0}}}};
  static constexpr int centre = 2;
  static constexpr std::array<double, 5> by_tt{1, 0, -2, 0, 1};
  static constexpr std::array<double, 5> by_xx{0, 1, -2, 1, 0};
  static constexpr std::array<bool, 5> nonlinear_in{true, false, false, false, true};

  Theory theory;

  template <class T>
  T nonlinear(const std::array<T, 5>& y) const {
    return theory.difference_quotient(y[4], y[0]);
  }
};

}  // namespace delf
