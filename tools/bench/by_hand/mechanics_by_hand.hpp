// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace delf::bench {

/// Loops that a competent programmer writes for one system of mechanics and one method, with the derivatives by hand.

/// q_{n+1} of (q_{n+1} − 2q_n + q_{n−1})/h + h/2 (sin m_{n−½} + sin m_{n+½}) = 0, m_{n+½} = (q_n + q_{n+1})/2, by Newton's
/// method from the straight line.
struct PendulumMidpointByHand {
  double h, tolerance, older = 0, q = 0;

  void start(double q0, double q1) { older = q0, q = q1; }
  void step() {
    const double known = (2 * q - older) / h - 0.5 * h * std::sin(0.5 * (older + q));
    double next = 2 * q - older;
    for (int iteration = 0; iteration < 20; ++iteration) {
      const double m = 0.5 * (q + next), E = next / h - known + 0.5 * h * std::sin(m);
      const double by = E / (1 / h + 0.25 * h * std::cos(m));
      next -= by;
      if (std::abs(by) <= tolerance) break;
    }
    older = std::exchange(q, next);
  }
};

/// q_{n+1} = 2q_n − q_{n−1} − h² q/|q|³ as an increment and a position.
struct KeplerVerletByHand {
  double h;
  std::array<double, 2> q{}, increment{};

  void start(std::array<double, 2> q0, std::array<double, 2> q1) { q = q1, increment = {q1[0] - q0[0], q1[1] - q0[1]}; }
  void step() {
    const double square = q[0] * q[0] + q[1] * q[1], pull = h * h / (square * std::sqrt(square));
    for (std::size_t a = 0; a < 2; ++a) increment[a] -= pull * q[a], q[a] += increment[a];
  }
};

/// Gauss's method of two stages for q'' = −sin q, by Newton's method for the two inner positions:
///
///     Q_i = q + c_i h v − h² Σ_j (A²)_ij sin Q_j
///     q ← q + hv − h² Σ b_j (1 − c_j) sin Q_j,   v ← v − h Σ b_j sin Q_j
///
struct PendulumGaussByHand {
  double h, tolerance, q = 0, v = 0;

  void start(double q0, double v0) { q = q0, v = v0; }
  void step() {
    const double root = std::sqrt(3.0) / 6, hh = h * h;
    const double c[2] = {0.5 - root, 0.5 + root};
    // A = [[¼, ¼ − √3/6], [¼ + √3/6, ¼]]
    const double A2[2][2] = {{0.0625 + (0.25 - root) * (0.25 + root), 0.5 * (0.25 - root)},
                             {0.5 * (0.25 + root), 0.0625 + (0.25 - root) * (0.25 + root)}};
    const double f = -std::sin(q);
    double x[2], s[2];
    for (int i = 0; i < 2; ++i) x[i] = q + c[i] * h * v + 0.5 * c[i] * c[i] * hh * f;
    for (int iteration = 0; iteration < 20; ++iteration) {
      double F[2], J[2][2];
      for (int j = 0; j < 2; ++j) s[j] = std::sin(x[j]);
      const double cosine[2] = {std::cos(x[0]), std::cos(x[1])};
      for (int i = 0; i < 2; ++i) {
        F[i] = x[i] - q - c[i] * h * v + hh * (A2[i][0] * s[0] + A2[i][1] * s[1]);
        for (int j = 0; j < 2; ++j) J[i][j] = (i == j) + hh * A2[i][j] * cosine[j];
      }
      const double by_determinant = 1 / (J[0][0] * J[1][1] - J[0][1] * J[1][0]);
      const double by[2] = {(F[0] * J[1][1] - F[1] * J[0][1]) * by_determinant,
                            (F[1] * J[0][0] - F[0] * J[1][0]) * by_determinant};
      x[0] -= by[0], x[1] -= by[1];
      if (std::max(std::abs(by[0]), std::abs(by[1])) <= tolerance) break;
    }
    for (int j = 0; j < 2; ++j) s[j] = std::sin(x[j]);
    q += h * v - 0.5 * hh * ((1 - c[0]) * s[0] + (1 - c[1]) * s[1]);
    v -= 0.5 * h * (s[0] + s[1]);
  }
};

}  // namespace delf::bench
