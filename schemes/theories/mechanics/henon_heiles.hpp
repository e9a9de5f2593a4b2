// SPDX-License-Identifier: MIT
#pragma once

namespace delf {

/// Hénon and Heiles's star in a galaxy: two oscillators with cubic terms. Bounded motions turn chaotic as the energy grows
/// to 1/6.
///
/// ℓ = ½|q_t|² − ½|q|² − q₁²q₂ + ⅓q₂³       q₁_tt + q₁ + 2q₁q₂ = 0,   q₂_tt + q₂ + q₁² − q₂² = 0
struct HenonHeiles {
  static constexpr int components = 2;

  auto operator()(const auto& j) const {
    const auto& q = j.phi;
    const auto& q_t = j.phi_t;
    return 0.5 * (q_t[0] * q_t[0] + q_t[1] * q_t[1]) - 0.5 * (q[0] * q[0] + q[1] * q[1]) - q[0] * q[0] * q[1] +
           (1.0 / 3) * (q[1] * q[1] * q[1]);
  }
};

}  // namespace delf
