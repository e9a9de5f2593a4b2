// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "jets/numbers/dual.hpp"
#include "jets/symmetry.hpp"

namespace delf {

/// A body around a centre of attraction, μ = GM: one point of space, q = (q₁, q₂).
///
/// ℓ = ½|q_t|² + μ/|q|                                     q_tt + μ q/|q|³ = 0
struct Kepler {
  static constexpr int components = 2;
  double attraction = 1;

  auto operator()(const auto& j) const {
    const auto& q = j.phi;
    const auto& q_t = j.phi_t;
    return 0.5 * (q_t[0] * q_t[0] + q_t[1] * q_t[1]) + attraction / sqrt(q[0] * q[0] + q[1] * q[1]);
  }

  /// rotations of the plane
  static std::vector<LinearSymmetry> symmetries() { return {{"angular_momentum", {0, -1, 1, 0}, {0, 0}}}; }
};

}  // namespace delf
