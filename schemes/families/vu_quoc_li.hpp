// SPDX-License-Identifier: MIT
#pragma once
#include <array>

#include "lattice/shapes/nine_tuple.hpp"

namespace delf {

/// The energy-conserving scheme of Vu-Quoc and Li, Marsden–Patrick–Shkoller (5.14), over the nine-tuple: no Lagrangian.
///
///   (¼∂²_k y_{j+1} + ½∂²_k y_j + ¼∂²_k y_{j−1})/k² − ∂²_h y/h² + ½(Q(y_{j+1}, y_j) + Q(y_j, y_{j−1})) = 0,
///   Q(a, b) = (N(a) − N(b))/(a − b)
template <class Theory>
struct VuQuocLi {
  static constexpr auto shape = shapes::nine_tuple;
  static constexpr int centre = 4;
  static constexpr std::array<double, 9> by_tt{0, 1, 0, 0, -2, 0, 0, 1, 0};
  static constexpr std::array<double, 9> by_xx{.25, -.5, .25, .5, -1, .5, .25, -.5, .25};
  static constexpr std::array<bool, 9> nonlinear_in{false, true, false, false, true, false, false, true, false};
  // Q(y_{j+1}, y_j) is half of what the rows j and j + 1 see.
  static constexpr std::array<bool, 9> part_in{false, false, false, false, true, false, false, true, false};
  static constexpr std::array<double, 9> shares{0, 0, 0, 0, .5, 0, 0, .5, 0};

  Theory theory;

  template <class T>
  T nonlinear(const std::array<T, 9>& y) const {
    return 0.5 * (theory.difference_quotient(y[7], y[4]) + theory.difference_quotient(y[4], y[1]));
  }
  template <class T>
  T part(const std::array<T, 9>& y) const {
    return theory.difference_quotient(y[7], y[4]);
  }
};

}  // namespace delf
