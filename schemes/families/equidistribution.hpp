// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "jets/expressions/evaluate.hpp"
#include "jets/stencil_lagrangian.hpp"
#include "lattice/index.hpp"
#include "lattice/shapes/six_tuple.hpp"

namespace delf {

/// The quantity that a mesh shares equally among its cells. For a cell with Δφ and δ = ΔX, Tyranowski–Desbrun §2.4:
///
///     arclength   F = α² Σ Δφ² + δ²                              (28), its square
///     saturated   F = δ² (1 + α² Σ Δφ²/(δ² + β² Σ Δφ²))          δ stays above β/α of the arclength's
///     uniform     F = δ                                          (122)
///     formula     F = ρ(φ, Δφ/δ) δ at the mean of φ              (24)
struct MeshMonitor {
  enum class Kind { arclength, saturated, uniform, formula };
  Kind kind = Kind::arclength;
  double alpha = 1, beta = 0;
  double strength = 1;  ///< 0: uniform; what a start grows
  /// of the variables φ_0, …, φ_0,X, …
  std::shared_ptr<const expressions::Evaluation> rho = {};

  /// a, b: the d fields and X at the ends of a cell.
  template <class T>
  T operator()(std::span<const T> a, std::span<const T> b) const {
    const std::size_t d = a.size() - 1;
    const T size = b[d] - a[d];
    if (kind == Kind::uniform) return size;
    if (kind == Kind::formula)
      return size * ((1 - strength) + strength * (*rho).template operator()<T>([&](int v) -> T {
               const std::size_t i = v;
               if (i < d) return 0.5 * (a[i] + b[i]);
               return (b[i - d] - a[i - d]) / size;
             }));
    T rise(0.0);
    for (std::size_t i = 0; i < d; ++i) rise = rise + (b[i] - a[i]) * (b[i] - a[i]);
    const double steep = strength * alpha * strength * alpha;
    if (kind == Kind::arclength) return steep * rise + size * size;
    const T square = size * size;
    return square * (1.0 + steep * rise / (square + (beta * beta) * rise));
  }
  /// G = F(right) − F(left) of the cells on both sides of a site, from the d fields and X at three sites.
  template <class T>
  T change(std::span<const T> left, std::span<const T> centre, std::span<const T> right) const {
    return (*this)(centre, right) - (*this)(left, centre);
  }
  /// The sum for sites that are stored one after the other.
  template <class T>
  T change(std::span<const T> q) const {
    const std::size_t n = q.size() / 3;
    return change(q.subspan(0, n), q.subspan(n, n), q.subspan(2 * n, n));
  }
};

/// Neighbouring cells have the same share, G = F(right) − F(left) = 0, with a multiplier λ at their common site: −λG, as in
/// Tyranowski–Desbrun (150), (155). Component d is X, and d + 1 is λ. G is taken on one row: ∂/∂q^j gives −Dg(q^j)ᵀ λ^j
/// and ∂/∂λ^{j+1} gives g(q^{j+1}) = 0, so that λ is Δt times the continuous multiplier.
struct Equidistribution {
  int d = 1;
  MeshMonitor monitor = {};

  StencilPattern pattern() const { return StencilPattern({{0, -1}, {0, 0}, {0, 1}}); }
  /// φ, X at the left; φ, X, λ at the centre; φ, X at the right
  std::vector<VertexValue> values() const {
    std::vector<VertexValue> list;
    for (int l = 0; l < 3; ++l)
      for (int c = 0; c <= d + (l == 1 ? 1 : 0); ++c) list.push_back({l, c});
    return list;
  }
  template <class T>
  T operator()(std::span<const T> y, const Cell&) const {
    const std::size_t n = at(d) + 1;
    const auto left = y.subspan(0, n), centre = y.subspan(n, n), right = y.subspan(2 * n + 1, n);
    return -(y[2 * n] * monitor.change(left, centre, right));
  }
};

/// A mesh that follows the monitor with a delay, Tyranowski–Desbrun §6.5: τ X_t = G in place of G = 0, for the step of rows
/// 0 and 1,
///
///     −μ [τ (X¹ − X⁰)/h − Σ_r b_r G(c_r q⁰ + (1 − c_r) q¹)]
///
/// with G at the mean of the rows, or the mean of G at both. Values q = (φ, X) at the three sites of row 0, then of row 1,
/// then μ.
struct DelayedEquidistribution {
  int d = 1;
  MeshMonitor monitor = {};
  double delay = 0;  ///< τ
  bool at_mean = true;

  StencilPattern pattern() const { return StencilPattern({{0, 0}}); }
  std::vector<VertexValue> values() const {
    std::vector<VertexValue> list;
    for (int c = 0; c <= 6 * (d + 1); ++c) list.push_back({0, c});
    return list;
  }
  template <class T>
  T operator()(std::span<const T> y, const Cell& cell) const {
    const std::size_t n = at(d) + 1;
    const auto G = [&](std::span<const T> q) -> T { return monitor.change(q); };
    const auto lower = y.subspan(0, 3 * n), upper = y.subspan(3 * n, 3 * n);
    T drive(0.0);
    if (at_mean) {
      thread_local std::vector<T> mean;
      mean.resize(3 * n);
      for (std::size_t i = 0; i < 3 * n; ++i) mean[i] = 0.5 * (lower[i] + upper[i]);
      drive = G(mean);
    } else {
      drive = 0.5 * (G(lower) + G(upper));
    }
    return -(y[6 * n] * ((delay / cell.time_step) * (upper[2 * n - 1] - lower[2 * n - 1]) - drive));
  }
};

}  // namespace delf
