// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "jets/simd/pack_math.hpp"
#include "lattice/index.hpp"
#include "tools/bench/by_hand/packed_band.hpp"

namespace delf::bench {

/// Spacetime elements of degree (2, 2) for sine-Gordon on a circle, two Gauss points in time: what is written by hand for
/// this one scheme. With mass and stiffness by columns (masses k/3 at vertices, 2k/3 between them),
///
///     ∂L/∂y_a = h Σ_r w_r [M φ_t,r ψ_a′/h − (K φ_r + M sin φ_r) ψ_a],     φ_r = Σ_a ψ_a(c_r) y_a,     a = 0, ½, 1
///     p_n + ∂L/∂y_0 = 0,   ∂L/∂y_½ = 0,   p_{n+1} = ∂L/∂y_1
///
/// is solved for y_½ and y_1 by Newton's method with the constant part of the Jacobian, factored once, from a polynomial
/// through eight steps.
class SpacetimeByHand {
 public:
  SpacetimeByHand(int cells, double space_step, double time_step, double tolerance)
      : N_(cells), k_(space_step), h_(time_step), tolerance_(tolerance), band_(4 * cells), E_(at(4 * cells)) {
    for (auto* levels : {&y_, &E_levels_})
      for (auto& level : *levels) level.assign(stride() * 2, 0.0);
    for (auto& past : past_) past.assign(stride() * 4, 0.0);
    for (auto* one : {&p_, &sine_, &phi_, &force_}) one->assign(stride() * 2, 0.0);
    const double root = std::sqrt(3.0) / 6;
    for (int r = 0; r < 2; ++r) {
      const double c = r == 0 ? 0.5 - root : 0.5 + root;
      value_[r] = {(1 - c) * (1 - 2 * c), 4 * c * (1 - c), c * (2 * c - 1)};
      slope_[r] = {4 * c - 3, 4 - 8 * c, 4 * c - 1};
    }
    factor();
  }

  /// Vertices and the nodes between them in turn: φ and φ_t.
  void start(const std::vector<double>& phi, const std::vector<double>& phi_t) {
    steps_ = 0;
    for (int i = 0; i < 2 * N_; ++i) {
      y_[2][place(i)] = phi[i];
      p_[place(i)] = mass(i % 2) * phi_t[i];
    }
  }
  void step() {
    y_[0] = y_[2];
    predict();
    double before = 0, largest = 0;
    for (int iteration = 1;; ++iteration) {
      slopes();
      for (int s = 0; s < 2 * N_; ++s)
        for (int b = 0; b < 2; ++b) E_[2 * node(s) + b] = E_levels_[b][place(s)];
      band_.solve(E_.data());
      double change = 0;
      largest = 0;
      for (int s = 0; s < 2 * N_; ++s)
        for (int b = 0; b < 2; ++b) {
          const double by = E_[2 * node(s) + b];
          double& y = y_[1 + b][place(s)];
          y -= by, change = std::max(change, std::abs(by)), largest = std::max(largest, std::abs(y));
        }
      if (!(change < 1e3) || iteration > 40) throw std::runtime_error("spacetime by hand: no convergence");
      const double ratio = iteration > 1 ? change / before : 1, wanted = tolerance_ * largest;
      if (change <= wanted || (ratio < 0.5 && 2 * ratio / (1 - ratio) * change <= wanted)) break;
      before = change;
    }
    slopes();
    p_ = E_levels_[2];
    std::ranges::copy(y_[1], past_[steps_ % order].begin());
    std::ranges::copy(y_[2], past_[steps_ % order].begin() + stride() * 2);
    ++steps_;
  }
  double newest(int i) const { return y_[2][place(i)]; }

 private:
  static constexpr int order = 8;
  // Vertices first, then the nodes right of them; each with a ghost before and after, in whole packs.
  int stride() const { return (N_ + 2 + lanes - 1) / lanes * lanes; }
  int place(int i) const { return i % 2 * stride() + 1 + i / 2; }
  int node(int s) const { return s < N_ ? 2 * s : 2 * (2 * N_ - s) - 1; }  ///< folded flat
  double mass(int kind) const { return (kind == 0 ? 1. : 2.) / 3 * k_; }

  void close(std::vector<double>& level) const {
    for (double* x = level.data(); x < level.data() + 2 * stride(); x += stride()) x[0] = x[N_], x[N_ + 1] = x[1];
  }
  void predict() {
    const int points = static_cast<int>(std::min<long>(order, steps_));
    for (int b = 0; b < 2; ++b) {
      std::vector<double>& y = y_[1 + b];
      if (points == 0) {
        y = y_[0];
        continue;
      }
      std::ranges::fill(y, 0.0);
      double weight = -1;
      for (int m = 1; m <= points; ++m) {
        weight *= -static_cast<double>(points - m + 1) / m;
        const double* const past = past_[(steps_ - m) % order].data() + b * stride() * 2;
        for (int i = 0; i < 2 * stride(); ++i) y[i] += weight * past[i];
      }
    }
  }
  /// ∂L/∂y_a, and p_n with the first.
  void slopes() {
    E_levels_[0] = p_;
    std::ranges::fill(E_levels_[1], 0.0), std::ranges::fill(E_levels_[2], 0.0);
    const int size = 2 * stride();
    for (int r = 0; r < 2; ++r) {
      const auto& [v0, v1, v2] = value_[r];
      const auto& [s0, s1, s2] = slope_[r];
      const double *a = y_[0].data(), *b = y_[1].data(), *c = y_[2].data();
      for (int i = 0; i < size; ++i) phi_[i] = v0 * a[i] + v1 * b[i] + v2 * c[i];
      close(phi_);
      for (int i = 0; i < size; i += lanes) {
        Pack x;
        std::memcpy(&x, phi_.data() + i, sizeof x);
        x = sin(x);
        std::memcpy(sine_.data() + i, &x, sizeof x);
      }
      const double *V = phi_.data(), *m = V + stride();
      for (int i = 1; i <= N_; ++i) {
        force_[i] = (14 * V[i] - 8 * (m[i - 1] + m[i]) + V[i - 1] + V[i + 1]) / (3 * k_) + mass(0) * sine_[i];
        force_[stride() + i] = (16 * m[i] - 8 * (V[i] + V[i + 1])) / (3 * k_) + mass(1) * sine_[stride() + i];
      }
      for (int kind = 0; kind < 2; ++kind)
        for (int i = kind * stride(); i < (kind + 1) * stride(); ++i) {
          const double momentum = 0.5 * mass(kind) / h_ * (s0 * a[i] + s1 * b[i] + s2 * c[i]);
          const double f = 0.5 * h_ * force_[i];
          E_levels_[0][i] += momentum * s0 - f * v0;
          E_levels_[1][i] += momentum * s1 - f * v1;
          E_levels_[2][i] += momentum * s2 - f * v2;
        }
    }
  }
  /// ∂(E_0, E_½)/∂(y_½, y_1) without the sine.
  void factor() {
    band_.set_zero();
    for (int s = 0; s < 2 * N_; ++s) {
      const auto add = [&](int to, double stiffness, double of_mass) {
        const int t = (to + 2 * N_) % (2 * N_);
        for (int a = 0; a < 2; ++a)
          for (int b = 0; b < 2; ++b)
            for (int r = 0; r < 2; ++r)
              band_.numbers()[band_.place(2 * node(s) + a, 2 * node(t) + b)] +=
                  0.5 *
                  (of_mass * slope_[r][a] * slope_[r][1 + b] / h_ - h_ * stiffness * value_[r][a] * value_[r][1 + b]);
      };
      add(s, (s % 2 == 0 ? 14 : 16) / (3 * k_), mass(s % 2));
      for (const int side : {-1, 1}) {
        add(s + side, -8 / (3 * k_), 0);
        if (s % 2 == 0) add(s + 2 * side, 1 / (3 * k_), 0);
      }
    }
    if (!band_.factor()) throw std::runtime_error("spacetime by hand: singular");
  }

  int N_;
  double k_, h_, tolerance_;
  PackedBand<9> band_;
  std::vector<double> E_, p_, sine_, phi_, force_;
  std::array<std::vector<double>, 3> y_, E_levels_;
  std::array<std::vector<double>, order> past_;
  std::array<std::array<double, 3>, 2> value_, slope_;  ///< ψ_a(c_r), ψ_a′(c_r)
  long steps_ = 0;
};

}  // namespace delf::bench
