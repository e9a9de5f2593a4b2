// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

namespace delf {

/// A Runge–Kutta method of other programs, for z_t = f(z):  Z_i = z + h Σ_j a_ij f(Z_j),  z₊ = z + h Σ_i b_i f(Z_i).
struct RungeKutta {
  std::string name;
  std::vector<std::vector<double>> a;
  std::vector<double> b;

  bool is_explicit() const;
};

/// E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, II.1 and II.5; and implicit ones.
/// None is symplectic in (φ, φ_t).
const std::vector<RungeKutta>& runge_kutta_methods();

}  // namespace delf
