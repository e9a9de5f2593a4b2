// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "jets/symmetry.hpp"

namespace delf {

/// A field with values on the unit sphere; the constraint is kept at every vertex by a multiplier.
///
/// ℓ = ½|u_t|² − ½|u_x|²,   |u|² = 1                       u_tt − u_xx + (|u_t|² − |u_x|²)u = 0
struct WaveMap {
  static constexpr int components = 3;

  auto operator()(const auto& j) const {
    const auto squared = [](const auto& u) { return u[0] * u[0] + u[1] * u[1] + u[2] * u[2]; };
    return 0.5 * (squared(j.phi_t) - squared(j.phi_x));
  }

  /// |u|² − 1, zero on the sphere
  auto constraint(const auto& u) const { return u[0] * u[0] + u[1] * u[1] + u[2] * u[2] - 1.0; }

  /// rotations of the sphere: ξ = e × u
  static std::vector<LinearSymmetry> symmetries() {
    return {{"rotation_x", {0, 0, 0, 0, 0, -1, 0, 1, 0}, {0, 0, 0}},
            {"rotation_y", {0, 0, 1, 0, 0, 0, -1, 0, 0}, {0, 0, 0}},
            {"rotation_z", {0, -1, 0, 1, 0, 0, 0, 0, 0}, {0, 0, 0}}};
  }
};

}  // namespace delf
