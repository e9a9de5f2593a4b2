// SPDX-License-Identifier: MIT
#pragma once

namespace delf::bench {

/// The linear part of the implicit schemes, A y_{n+1} − B y_n + A y_{n−1}, with A = (a₁, a₀, a₁) and B = (b₁, b₀, b₁)
/// across space.
struct WavePart {
  double a0, a1, b0, b1;

  /// (5.12): ¼(∂²_h y_{i+1} + 2∂²_h y_i + ∂²_h y_{i−1})/h² − ¼(∂²_k y_{j+1} + 2∂²_k y_j + ∂²_k y_{j−1})/k²
  static WavePart symmetric(double h, double k) {
    const double t = 1 / (h * h), x = 1 / (k * k);
    return {0.5 * (t + x), 0.25 * (t - x), t - x, 0.5 * (t + x)};
  }
  /// (5.10), (5.14): ∂²_h y_i/h² − ¼(∂²_k y_{j+1} + 2∂²_k y_j + ∂²_k y_{j−1})/k²
  static WavePart rectangle(double h, double k) {
    const double t = 1 / (h * h), x = 1 / (k * k);
    return {t + 0.5 * x, -0.25 * x, 2 * t - x, 0.5 * x};
  }

  /// B y_n − A y_{n−1} at the site that the pointers stand at.
  double known(const double* y, const double* older) const {
    return b0 * y[0] + b1 * (y[-1] + y[1]) - a0 * older[0] - a1 * (older[-1] + older[1]);
  }
};

}  // namespace delf::bench
