// SPDX-License-Identifier: MIT
#pragma once
#include "jets/numbers/sinc.hpp"

namespace delf {

/// Two equal pendulums, one hung from the other, in units of their mass, their length and gravity; angles from the
/// vertical. The mass matrix depends on q.
///
/// ℓ = q₁_t² + ½q₂_t² + q₁_t q₂_t cos(q₁ − q₂) + 2(cos q₁ − 1) + cos q₂ − 1
struct DoublePendulum {
  static constexpr int components = 2;

  auto operator()(const auto& j) const {
    const auto& q = j.phi;
    const auto& q_t = j.phi_t;
    return q_t[0] * q_t[0] + 0.5 * (q_t[1] * q_t[1]) + q_t[0] * q_t[1] * cos(q[0] - q[1]) + 2.0 * cosm1(q[0]) +
           cosm1(q[1]);
  }
};

}  // namespace delf
