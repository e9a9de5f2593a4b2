// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <span>
#include <vector>

#include "jets/numbers/sinc.hpp"
#include "jets/stencil_lagrangian.hpp"
#include "lattice/shapes/rectangle.hpp"
#include "lattice/shapes/six_tuple.hpp"

namespace delf {

/// Sine-Gordon of mass m on a mesh that is a field itself, Tyranowski–Desbrun (154)–(158): component 0 is φ, 1 is X, both
/// piecewise linear in x; the integrals over x are exact. With δ = X_{i+1} − X_i and γ = (y_{i+1} − y_i)/δ on a row,
///
///   L̃(□) = Δt/2 Σ_{rows j, j+1} ( δ/6 (w_i² + w_i w_{i+1} + w_{i+1}²) − ½γ²δ − m²δ (1 − C) ),      (157), (44), (170)
///   w = (y^{j+1} − y^j)/Δt − γ (X^{j+1} − X^j)/Δt
///   C = (sin y_{i+1} − sin y_i)/(y_{i+1} − y_i) = cos((y_i + y_{i+1})/2) sinc((y_i − y_{i+1})/2)
struct MovingRectangle {
  double mass = 1;

  StencilPattern pattern() const { return StencilPattern(shapes::rectangle); }
  std::vector<VertexValue> values() const { return {{0, 0}, {0, 1}, {1, 0}, {1, 1}, {2, 0}, {2, 1}, {3, 0}, {3, 1}}; }

  /// ∫ ½w² dx over a cell
  template <class T>
  static T kinetic(const T& size, const T& w_a, const T& w_b) {
    return (1. / 6) * (size * (w_a * w_a + w_a * w_b + w_b * w_b));
  }

  /// ∫ ℓ dx over a cell of one row, from (φ, X) and (φ_t, X_t) at its ends
  template <class T>
  T of_row(const T& a, const T& mesh_a, const T& b, const T& mesh_b, const T& a_t, const T& mesh_a_t, const T& b_t,
           const T& mesh_b_t) const {
    using std::cos;
    const T size = mesh_b - mesh_a, slope = (b - a) / size;
    const T w_a = a_t - slope * mesh_a_t, w_b = b_t - slope * mesh_b_t;
    const T mean_cos = cos(0.5 * (a + b)) * sinc(0.5 * (a - b));
    return kinetic(size, w_a, w_b) - size * (0.5 * slope * slope + (mass * mass) * (1.0 - mean_cos));
  }

  /// y = (φ, X) at (j, i), (j+1, i), (j+1, i+1), (j, i+1)
  template <class T>
  T operator()(std::span<const T> y, const Cell& cell) const {
    const double per_h = 1 / cell.time_step;
    const T left_t = per_h * (y[2] - y[0]), left_mesh_t = per_h * (y[3] - y[1]);
    const T right_t = per_h * (y[4] - y[6]), right_mesh_t = per_h * (y[5] - y[7]);
    const auto row = [&](const T& a, const T& mesh_a, const T& b, const T& mesh_b) -> T {
      return of_row(a, mesh_a, b, mesh_b, left_t, left_mesh_t, right_t, right_mesh_t);
    };
    return (0.5 * cell.time_step) * (row(y[0], y[1], y[6], y[7]) + row(y[2], y[3], y[4], y[5]));
  }
};

/// The moving cell at one weighted point of an element in time: (φ, X) at the ends of the cell, then h (φ_t, X_t).
struct MovingStage {
  MovingRectangle rectangle;
  double weight = 1;

  StencilPattern pattern() const { return StencilPattern({{0, 0}}); }
  std::vector<VertexValue> values() const { return {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}, {0, 6}, {0, 7}}; }

  template <class T>
  T operator()(std::span<const T> y, const Cell& cell) const {
    const double per_h = 1 / cell.time_step;
    return (weight * cell.time_step) *
           rectangle.of_row<T>(y[0], y[1], y[2], y[3], per_h * y[4], per_h * y[5], per_h * y[6], per_h * y[7]);
  }
};

/// Equidistributed arclength with its multiplier, Tyranowski–Desbrun (28): −λ G on the six-tuple, as in (150), (155),
///
///   G = α²(y_{i+1} − y_i)² + (X_{i+1} − X_i)² − α²(y_i − y_{i−1})² − (X_i − X_{i−1})²
///
/// λ is component 2 at the centre of the lower row and G is taken on that row, so that ∂/∂q^j gives −Dg(q^j)ᵀ λ^j and
/// ∂/∂λ^{j+1} gives g(q^{j+1}) = 0: (155). A step solves for q^{j+1} and λ^j, which is Δt times the continuous
/// multiplier.
struct ArclengthConstraint {
  double alpha = 1;

  StencilPattern pattern() const { return StencilPattern(shapes::six_tuple); }
  std::vector<VertexValue> values() const { return {{0, 0}, {0, 1}, {1, 0}, {1, 1}, {1, 2}, {2, 0}, {2, 1}}; }

  /// y = (φ, X) at (j, i−1); (φ, X, λ) at (j, i); (φ, X) at (j, i+1)
  template <class T>
  T operator()(std::span<const T> y, const Cell&) const {
    const T left = y[2] - y[0], left_size = y[3] - y[1], right = y[5] - y[2], right_size = y[6] - y[3];
    const double a = alpha * alpha;
    return -(y[4] * (a * (right * right) + right_size * right_size - a * (left * left) - left_size * left_size));
  }
};

}  // namespace delf
