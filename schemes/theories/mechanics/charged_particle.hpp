// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>

namespace delf {

/// A massless charged particle in the plane, in a magnetic field that grows outwards and an electric potential: it drifts
/// along H = const.
///
/// ℓ = θ(q)·q_t − H(q),   θ = ½(1 + x² + y²)(−y, x),   H = cos x + sin y
struct ChargedParticle {
  static constexpr int components = 2;

  auto operator()(const auto& j) const {
    using std::cos;
    const auto& [x, y] = j.phi;
    const auto& [x_t, y_t] = j.phi_t;
    // sin y = cos(y − π/2)
    return 0.5 * (1.0 + x * x + y * y) * (x * y_t - y * x_t) - cos(x) - cos(y - 1.5707963267948966);
  }
};

}  // namespace delf
