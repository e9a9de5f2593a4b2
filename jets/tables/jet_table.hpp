// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <concepts>

#include "jets/jet.hpp"
#include "lattice/index.hpp"
#include "lattice/stencil_shape.hpp"

namespace delf {

/// One quadrature point of a stencil: the jet there as weights of the vertex values, with h = k = 1.
///
///     φ = Σ_l phi[l] y_l        φ_t = Σ_l phi_t[l] y_l / h        φ_x = Σ_l phi_x[l] y_l / k
///
/// and likewise φ_tt, φ_tx and φ_xx, where a stencil has room for second derivatives.
template <int n>
struct QuadraturePoint {
  using Weights = std::array<double, at(n)>;
  double weight;
  Weights phi, phi_t, phi_x;
  Weights phi_tt = {}, phi_tx = {}, phi_xx = {};
};

/// A linear jet map: a stencil shape, and (φ, φ_t, φ_x) at Q quadrature points. It is all that tells one lattice
/// scheme from another:  L_Δ = |Δ| Σ_q w_q ℓ(φ_q, φ_t,q, φ_x,q),  |Δ| = measure · h k.
template <int n, int Q>
struct JetTable {
  static constexpr int vertices = n;
  static constexpr int points = Q;

  Offsets<n> shape;
  /// The share of spacetime that one stencil stands for, in cells hk, so that Σ_Δ |Δ| is the area: 1 where there is
  /// a stencil for each site.
  double measure;
  std::array<QuadraturePoint<n>, at(Q)> quadrature;

  constexpr const QuadraturePoint<n>& point(int q) const { return quadrature[q]; }
};

/// True if the weights of a table make sense: those of the quadrature sum to 1, and on an affine field
/// φ = α + βt + γx every point finds φ_t = β and φ_x = γ.
template <int n, int Q>
constexpr bool is_consistent(const JetTable<n, Q>& table) {
  const auto near = [](double a, double b) { return a - b < 1e-12 && b - a < 1e-12; };
  // On one point of space there is no φ_x to find.
  bool wide = false;
  for (int l = 1; l < n; ++l) wide = wide || table.shape.vertex(l).space != table.shape.vertex(0).space;
  double total = 0;
  for (int q = 0; q < Q; ++q) {
    const QuadraturePoint<n>& p = table.point(q);
    total += p.weight;
    double phi_1 = 0, t_1 = 0, t_t = 0, t_x = 0, x_1 = 0, x_t = 0, x_x = 0;
    for (int l = 0; l < n; ++l) {
      const Site v = table.shape.vertex(l);
      phi_1 += p.phi[l];
      t_1 += p.phi_t[l], t_t += p.phi_t[l] * v.time, t_x += p.phi_t[l] * v.space;
      x_1 += p.phi_x[l], x_t += p.phi_x[l] * v.time, x_x += p.phi_x[l] * v.space;
    }
    if (!near(phi_1, 1) || !near(t_1, 0) || !near(t_t, 1) || !near(t_x, 0) || !near(x_1, 0) || !near(x_t, 0) ||
        !near(x_x, wide ? 1 : 0))
      return false;
  }
  return near(total, 1);
}

/// A jet map is a type with a static constexpr JetTable named `table`, so that a scheme knows all weights when it is
/// compiled:
///
///     struct Box {
///       static constexpr delf::JetTable<4, 1> table{shape, 1, {{{1, {phi…}, {phi_t…}, {phi_x…}}}}};
///     };
///
template <class M>
concept JetMap = requires {
  { M::table.measure } -> std::convertible_to<double>;  // a jet map needs `static constexpr JetTable<n, Q> table`
  requires StencilShape<decltype(M::table.shape)>;      // its shape: offsets {time, space}
  requires is_consistent(M::table);  // weights: sum to 1 (quadrature, phi); exact on affine fields (phi_t, phi_x)
};

/// The place of a quadrature point relative to the anchor, in steps: ξ = Σ_l phi[l] · (space offset of l).
template <int n>
constexpr double space_offset(const Offsets<n>& shape, const QuadraturePoint<n>& point) {
  double xi = 0;
  for (int l = 0; l < n; ++l) xi += point.phi[l] * shape.vertex(l).space;
  return xi;
}
template <int n>
constexpr double time_offset(const Offsets<n>& shape, const QuadraturePoint<n>& point) {
  double tau = 0;
  for (int l = 0; l < n; ++l) tau += point.phi[l] * shape.vertex(l).time;
  return tau;
}

}  // namespace delf
