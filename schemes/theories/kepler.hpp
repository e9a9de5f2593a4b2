// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "jets/numbers/dual.hpp"
#include "jets/symmetry.hpp"

namespace delf {

/// A body around a centre of attraction, in units where μ = 1: one point of space, q = (q₁, q₂).
///
/// ℓ = ½|q_t|² + 1/|q|                                     q_tt + q/|q|³ = 0
struct Kepler {
  static constexpr int components = 2;

  auto operator()(const auto& j) const {
    const auto& q = j.phi;
    const auto& q_t = j.phi_t;
    return 0.5 * (q_t[0] * q_t[0] + q_t[1] * q_t[1]) + 1.0 / sqrt(q[0] * q[0] + q[1] * q[1]);
  }

  /// rotations of the plane
  static std::vector<LinearSymmetry> symmetries() { return {{"angular_momentum", {0, -1, 1, 0}, {0, 0}}}; }
};

}  // namespace delf
