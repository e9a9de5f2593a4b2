// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "jets/symmetry.hpp"

namespace delf {

/// The rotation of n planes together, A = diag(J, …, J).
inline LinearSymmetry rotation_of_planes(std::size_t n) {
  LinearSymmetry rotation{"rotation", std::vector<double>(4 * n * n, 0.0), std::vector<double>(2 * n, 0.0)};
  for (std::size_t i = 0; i < n; ++i) {
    rotation.matrix[2 * i * 2 * n + 2 * i + 1] = -1;
    rotation.matrix[(2 * i + 1) * 2 * n + 2 * i] = 1;
  }
  return rotation;
}

/// Three vortices in the plane, of strengths Γ = (1, 0.8, −0.5), q = (x₁, y₁, x₂, y₂, x₃, y₃).
///
/// ℓ = Σ_i ½Γ_i (x_i y_i,t − y_i x_i,t) − H,   H = −Σ_{i<j} Γ_iΓ_j log|q_i − q_j|²/(4π)
struct ThreeVortices {
  static constexpr int components = 6;

  auto operator()(const auto& j) const {
    using std::log;
    constexpr std::array strengths{1.0, 0.8, -0.5};
    const auto& q = j.phi;
    const auto& v = j.phi_t;
    auto l = 0.5 * strengths[0] * (q[0] * v[1] - q[1] * v[0]);
    for (std::size_t i = 1; i < 3; ++i) l += 0.5 * strengths[i] * (q[2 * i] * v[2 * i + 1] - q[2 * i + 1] * v[2 * i]);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = i + 1; k < 3; ++k) {
        const auto x = q[2 * i] - q[2 * k], y = q[2 * i + 1] - q[2 * k + 1];
        l += strengths[i] * strengths[k] / (4 * 3.14159265358979323846) * log(x * x + y * y);
      }
    return l;
  }
  static std::vector<LinearSymmetry> symmetries() { return {rotation_of_planes(3)}; }
};

/// Two vortices in a field that grows outwards, q = (x₁, y₁, x₂, y₂).
///
/// ℓ = Σ_i ¼S_i (x_i y_i,t − y_i x_i,t) − H,   S_i = 1 + |q_i|²,   H = S₁S₂ log|q₁ − q₂|²/(8π)
struct TwoVortices {
  static constexpr int components = 4;

  auto operator()(const auto& j) const {
    using std::log;
    const auto& q = j.phi;
    const auto& v = j.phi_t;
    const auto S1 = 1.0 + q[0] * q[0] + q[1] * q[1], S2 = 1.0 + q[2] * q[2] + q[3] * q[3];
    const auto x = q[0] - q[2], y = q[1] - q[3];
    return 0.25 * (S1 * (q[0] * v[1] - q[1] * v[0]) + S2 * (q[2] * v[3] - q[3] * v[2])) -
           1 / (8 * 3.14159265358979323846) * (S1 * S2) * log(x * x + y * y);
  }
  static std::vector<LinearSymmetry> symmetries() { return {rotation_of_planes(2)}; }
};

}  // namespace delf
