// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "jets/symmetry.hpp"

namespace delf {

/// ℓ = ½φ_t² − ½φ_x²                                       φ_tt − φ_xx = 0
struct Wave {
  auto operator()(const auto& j) const { return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x); }

  /// (N(a) − N(b))/(a − b), N = 0
  template <class T>
  T difference_quotient(const T& a, const T&) const {
    return 0.0 * a;
  }

  /// φ ↦ φ + ε
  static std::vector<LinearSymmetry> symmetries() { return {{"translation", {0}, {1}}}; }
};

}  // namespace delf
