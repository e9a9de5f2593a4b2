// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "jets/symmetry.hpp"

namespace delf {

/// A pendulum that swings in all directions, in units of its length and gravity, downwards −q₃; its rod is a constraint,
/// kept by a multiplier.
///
/// ℓ = ½|q_t|² − q₃,   |q|² = 1                            q_tt + e₃ = λq
struct SphericalPendulum {
  static constexpr int components = 3;

  auto operator()(const auto& j) const {
    const auto& v = j.phi_t;
    return 0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - j.phi[2];
  }

  /// |q|² − 1
  auto constraint(const auto& q) const { return q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - 1.0; }

  /// rotations about the vertical
  static std::vector<LinearSymmetry> symmetries() {
    return {{"angular_momentum", {0, -1, 0, 1, 0, 0, 0, 0, 0}, {0, 0, 0}}};
  }
};

}  // namespace delf
