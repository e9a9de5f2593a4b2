// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <utility>

#include "jets/density.hpp"
#include "jets/tables/jet_table.hpp"
#include "lattice/index.hpp"

namespace delf {

/// The place of a stencil and the size of its cell: all that L_Δ depends on besides the vertex values.
struct Cell {
  double time_step = 1;   ///< h; negative in a sub-step that goes back, and the measure with it
  double space_step = 1;  ///< k
  double t = 0, x = 0;    ///< of the anchor
  int stencil = 0;        ///< of a family whose stencils are listed: its number
};

/// L_Δ(y¹, …, yⁿ) = |Δ| Σ_q w_q ℓ(φ_q, φ_t,q, φ_x,q): the discrete Lagrangian of a density on the jets of a stencil.
/// The values of a field with d components are ordered vertex by vertex: y[l·d + a].
template <JetMap Map, Density D>
struct DiscreteLagrangian {
  static constexpr const auto& map = Map::table;
  static constexpr int n = map.vertices;
  static constexpr int d = components_of<D>();
  static constexpr int size = n * d;

  D density;

  template <class T>
  T operator()(const std::array<T, at(size)>& y, const Cell& cell) const {
    T sum(0.0);
    for (int q = 0; q < map.points; ++q) sum += map.point(q).weight * density(jet(q, y, cell));
    return (map.measure * cell.time_step * cell.space_step) * sum;
  }

  /// The continuous jet that the vertex values stand for at quadrature point q.
  template <class T>
  JetFor<T, D> jet(int q, const std::array<T, at(size)>& y, const Cell& cell) const {
    JetFor<T, D> j;
    const auto& p = map.point(q);
    for (int a = 0; a < d; ++a) {
      T value(0.0), by_t(0.0), by_x(0.0);
      for (int l = 0; l < n; ++l) {
        const T& yl = y[l * d + a];
        if (p.phi[l] != 0) value += p.phi[l] * yl;
        if (p.phi_t[l] != 0) by_t += p.phi_t[l] * yl;
        if (p.phi_x[l] != 0) by_x += p.phi_x[l] * yl;
      }
      component(j.phi, a) = value;
      component(j.phi_t, a) = (1 / cell.time_step) * by_t;
      component(j.phi_x, a) = (1 / cell.space_step) * by_x;
    }
    if constexpr (is_placed<D>()) {
      j.t = T(cell.t + time_offset(map.shape, p) * cell.time_step);
      j.x = T(cell.x + space_offset(map.shape, p) * cell.space_step);
    }
    return j;
  }

  using Values = std::array<double, at(size)>;

  /// ∂L/∂y[l·d + a], by forward differentiation.
  Values gradient(const Values& y, const Cell& cell) const {
    using Number = Dual<double, size>;
    std::array<Number, at(size)> variables;
    for (int i = 0; i < size; ++i) variables[i] = Number::variable(y[i], i);
    return (*this)(variables, cell).d;
  }

  /// ∂²L/∂y∂y, row by row, by forward differentiation twice.
  std::array<double, at(size* size)> hessian(const Values& y, const Cell& cell) const {
    using Inner = Dual<double, size>;
    using Outer = Dual<Inner, size>;
    std::array<Outer, at(size)> variables;
    for (int i = 0; i < size; ++i) variables[i] = Outer::variable(Inner::variable(y[i], i), i);
    const Outer result = (*this)(variables, cell);
    std::array<double, at(size * size)> matrix;
    for (int i = 0; i < size; ++i)
      for (int j = 0; j < size; ++j) matrix[i * size + j] = result.d[i].d[j];
    return matrix;
  }
};

template <JetMap Map, Density D>
DiscreteLagrangian<Map, D> discrete_lagrangian(Map, D density) {
  return {std::move(density)};
}

}  // namespace delf
