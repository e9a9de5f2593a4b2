// SPDX-License-Identifier: MIT
#pragma once
#include <array>

namespace delf::peers {

/// k² ∂²_x by central differences of order 2p: c_0 φ_i + Σ_m c_m (φ_{i+m} + φ_{i−m}), 1 ≤ m ≤ p, with
///
///     c_m = 2(−1)^{m+1} (p!)² / (m² (p − m)! (p + m)!),   c_0 = −2 Σ_m c_m
///
/// (B. Fornberg, A Practical Guide to Pseudospectral Methods, 1996).
template <int p>
constexpr std::array<double, p + 1> second_difference() {
  std::array<double, p + 1> c{};
  double ratio = 1;  // (p!)² / ((p − m)! (p + m)!)
  for (int m = 1; m <= p; ++m) {
    ratio *= static_cast<double>(p - m + 1) / (p + m);
    c[m] = (m % 2 == 1 ? 2 : -2) * ratio / (m * m);
    c[0] -= 2 * c[m];
  }
  return c;
}

/// The largest (kκ)²: that of φ_i = (−1)ⁱ.
template <int p>
constexpr double highest_square() {
  constexpr std::array<double, p + 1> c = second_difference<p>();
  double s = -c[0];
  for (int m = 1; m <= p; ++m) s += (m % 2 == 1 ? 2 : -2) * c[m];
  return s;
}

}  // namespace delf::peers
