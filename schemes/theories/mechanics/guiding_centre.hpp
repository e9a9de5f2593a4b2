// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <vector>

#include "jets/symmetry.hpp"

namespace delf {

/// The guiding centre of a charged particle in an axisymmetric tokamak, q = (R, Z, φ, u): cylindrical coordinates and the
/// velocity along the magnetic field. R₀ = 2, B₀ = 5, safety factor q₀ = 2, magnetic moment μ = 0.01.
///
/// ℓ = θ(q)·q_t − H(q),   H = ½u² + μ|B|,   |B| = (B₀/R) √(r²/q₀² + R₀²),   r² = (R − R₀)² + Z²
/// θ_R = B₀R₀Z/(2R) − uB₀Z/(q₀R|B|)
/// θ_Z = −½B₀R₀ log(R/R₀) + uB₀(R − R₀)/(q₀R|B|)
/// θ_φ = −B₀r²/(2q₀) − uB₀R₀/|B|
struct GuidingCentre {
  static constexpr int components = 4;

  auto operator()(const auto& j) const {
    using std::log, std::sqrt;
    constexpr double R0 = 2, B0 = 5, q0 = 2, mu = 0.01;
    const auto& [R, Z, phi, u] = j.phi;
    const auto& [R_t, Z_t, phi_t, u_t] = j.phi_t;
    const auto x = R - R0;
    const auto r2 = x * x + Z * Z;
    const auto B = B0 * sqrt(r2 * (1 / (q0 * q0)) + R0 * R0) / R;
    const auto theta_R = (0.5 * B0 * R0) * Z / R - (B0 / q0) * (u * Z) / (R * B);
    const auto theta_Z = (-0.5 * B0 * R0) * log(R * (1 / R0)) + (B0 / q0) * (u * x) / (R * B);
    const auto theta_phi = (-0.5 * B0 / q0) * r2 - (B0 * R0) * u / B;
    return theta_R * R_t + theta_Z * Z_t + theta_phi * phi_t - 0.5 * (u * u) - mu * B;
  }

  /// The toroidal angle: θ_φ is conserved.
  static std::vector<LinearSymmetry> symmetries() {
    return {{"toroidal momentum", std::vector<double>(16, 0.0), {0, 0, 1, 0}}};
  }
};

}  // namespace delf
