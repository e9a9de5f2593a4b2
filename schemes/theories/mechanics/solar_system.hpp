// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "jets/numbers/dual.hpp"
#include "jets/symmetry.hpp"

namespace delf {

/// The Sun and the outer planets, Jupiter to Pluto, in astronomical units, days and masses of the Sun: six bodies, 18
/// coordinates, body by body. The Sun has the mass of the inner planets too.
///
/// ℓ = Σ_i ½m_i|q_i,t|² + Σ_{i<j} G m_i m_j/|q_i − q_j|
struct SolarSystem {
  static constexpr int bodies = 6, components = 3 * bodies;
  // Hairer, Lubich and Wanner, Geometric Numerical Integration, I.2.4
  static constexpr double G = 2.95912208286e-4;
  static constexpr std::array<double, bodies> mass{1.00000597682,      0.000954786104043,  0.000285583733151,
                                                   0.0000437273164546, 0.0000517759138449, 1 / 1.3e8};

  auto operator()(const auto& j) const {
    const auto& q = j.phi;
    const auto& v = j.phi_t;
    const auto kinetic = [&](std::size_t i) {
      return (0.5 * mass[i]) * (v[3 * i] * v[3 * i] + v[3 * i + 1] * v[3 * i + 1] + v[3 * i + 2] * v[3 * i + 2]);
    };
    auto L = kinetic(0);
    for (std::size_t i = 1; i < mass.size(); ++i) L = L + kinetic(i);
    for (std::size_t i = 0; i < mass.size(); ++i)
      for (std::size_t k = i + 1; k < mass.size(); ++k) {
        const auto x = q[3 * i] - q[3 * k], y = q[3 * i + 1] - q[3 * k + 1], z = q[3 * i + 2] - q[3 * k + 2];
        L = L + (G * mass[i] * mass[k]) / sqrt(x * x + y * y + z * z);
      }
    return L;
  }

  /// translations, and rotations ξ = e × q, of all bodies together
  static std::vector<LinearSymmetry> symmetries() {
    constexpr std::size_t d = components;
    constexpr const char* axes[] = {"x", "y", "z"};
    std::vector<LinearSymmetry> all;
    for (std::size_t e = 0; e < 3; ++e) {
      LinearSymmetry move{std::string("momentum_") + axes[e], std::vector<double>(d * d), std::vector<double>(d)};
      for (std::size_t i = 0; i < bodies; ++i) move.shift[3 * i + e] = 1;
      all.push_back(move);
    }
    for (std::size_t e = 0; e < 3; ++e) {
      LinearSymmetry turn{std::string("rotation_") + axes[e], std::vector<double>(d * d), std::vector<double>(d)};
      const std::size_t from = (e + 1) % 3, to = (e + 2) % 3;
      for (std::size_t i = 0; i < bodies; ++i) {
        turn.matrix[(3 * i + to) * d + 3 * i + from] = 1;
        turn.matrix[(3 * i + from) * d + 3 * i + to] = -1;
      }
      all.push_back(turn);
    }
    return all;
  }
};

}  // namespace delf
