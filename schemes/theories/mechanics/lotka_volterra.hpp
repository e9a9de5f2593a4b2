// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>

namespace delf {

/// Predators and prey. The equations are the same in every gauge; what a scheme makes of them is not.
///
/// ℓ = θ(q)·q_t − H(q),   H = q₁ + q₂ − log q₁ − 2 log q₂        q₁_t = q₁(q₂ − 2),   q₂_t = q₂(1 − q₁)
///
/// full        θ = (q₂ + log(q₂)/q₁, q₁)
/// x           θ = (log(q₂)/q₁, 0)
/// symmetric   θ = (½ log(q₂)/q₁, −½ log(q₁)/q₂)
enum class LotkaVolterraGauge { full, x, symmetric };

template <LotkaVolterraGauge gauge>
struct LotkaVolterra {
  static constexpr int components = 2;

  auto operator()(const auto& j) const {
    using std::log;
    const auto& [x, y] = j.phi;
    const auto& [x_t, y_t] = j.phi_t;
    const auto log_x = log(x), log_y = log(y);
    const auto H = x + y - log_x - 2.0 * log_y;
    if constexpr (gauge == LotkaVolterraGauge::full) return (y + log_y / x) * x_t + x * y_t - H;
    else if constexpr (gauge == LotkaVolterraGauge::x) return log_y / x * x_t - H;
    else return 0.5 * (log_y / x * x_t - log_x / y * y_t) - H;
  }
};

}  // namespace delf
