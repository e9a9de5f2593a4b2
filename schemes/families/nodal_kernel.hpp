// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cmath>
#include <span>

#include "jets/density.hpp"
#include "jets/discrete_lagrangian.hpp"
#include "schemes/stepping/rows/row_layout.hpp"
#include "schemes/families/value_jet.hpp"

namespace delf {

/// The rows of one sub-step, d of each, and its coefficients.
struct SubStepRows {
  const RowLayout* layout;
  const double* const* now;          ///< y
  double* const* next;               ///< may be `now`
  const double* const* differences;  ///< y(i + 1) − y(i), halos filled as far as pairs reach
  double* const* next_differences;   ///< other rows than those; all but that of the last pack are found
  double* const* velocity;           ///< replaced by the new one
  const double* positions;           ///< x of each slot's site; null unless the density is placed
  double t;                          ///< of the row `now`
  const double* linear;              ///< [a·reach + j]: Σ_{m > j} of the coefficients g_m of the sites i ± m
  const double* nonlinear;           ///< [a]
  double stride;
};

/// What an element has whose φ at every quadrature point is the value at one of its nodes, for a density that is
/// nonlinear in φ alone: the nonlinear part of the equation at a node is that of its own value, and rows of nodes can
/// follow each other by one loop each.
class NodalKernel {
 public:
  static constexpr int most_reach = 6;  ///< that loops are compiled for
  virtual ~NodalKernel() = default;
  /// How far the sites of a pair are apart at most.
  virtual int reach() const = 0;
  /// What one unit of ∂ℓ/∂φ(φ, 0, 0) at the node of value i adds to the residual r[i].
  virtual double weight(const Cell&, int i) const = 0;
  /// The constant Jacobian of all but that part of r.
  virtual void linear_part(const Cell&, std::span<double> J) const = 0;
  /// sub_step_loop() for this reach.
  virtual double step(const SubStepRows&) const = 0;
};

/// One sub-step of a row, with D(i) = y(i + 1) − y(i):
///
///     u += Σ_m g_m (y(i + m) − 2y(i) + y(i − m)) + nonlinear ∂ℓ/∂φ(y(i)),    next = y + stride u
///
/// where the sum is Σ_j linear(j) (D(i + j) − D(i − 1 − j)): half the operations, and still differences only.
/// Returns √Σ next²: infinite or NaN where squares overflow.
template <int reach, Density D>
[[gnu::__flatten__, gnu::__noclone__]] double sub_step_loop(const D& given_density, const SubStepRows& given) {
  constexpr int d = components_of<D>();
  // Copies of this function alone: what is stored through others cannot change them, so that they stay in registers.
  const D density = given_density;
  const double stride = given.stride;
  const double* const positions = given.positions;
  const Pack t(given.t);
  std::array<const double*, d> now, differences;
  std::array<double*, d> next, velocity, next_differences;
  std::array<double, static_cast<std::size_t>(d * reach)> linear;
  std::array<double, d> nonlinear;
  std::array<Pack, d> before;
  for (int a = 0; a < d; ++a) {
    now[a] = given.now[a], next[a] = given.next[a], velocity[a] = given.velocity[a], nonlinear[a] = given.nonlinear[a];
    differences[a] = given.differences[a], next_differences[a] = given.next_differences[a];
    for (int j = 0; j < reach; ++j) linear[a * reach + j] = given.linear[a * reach + j];
    before[a] = Pack(0.0);
  }
  const std::ptrdiff_t begin = given.layout->at(0), end = given.layout->at(given.layout->packs());
  Pack squares(0.0);
  for (std::ptrdiff_t at = begin; at < end; at += lanes) {
    const Dual<Pack, d> l = density(value_jet<D>([&](int a) { return Pack::load(now[a] + at); }, t, positions + at));
    for (int a = 0; a < d; ++a) {
      // Two sums: one would wait for itself.
      Pack even = Pack::load(velocity[a] + at), odd(0.0);
      for (int j = 0; j < reach; ++j)
        (j % 2 == 0 ? even : odd) += linear[a * reach + j] * (Pack::load(differences[a] + at + j * lanes) -
                                                              Pack::load(differences[a] + at - (j + 1) * lanes));
      const Pack u = (even + nonlinear[a] * l.derivative(a)) + odd, y = Pack::load(now[a] + at) + stride * u;
      squares += y * y;
      u.store(velocity[a] + at);
      y.store(next[a] + at);
      // The first of these lies in the halo, which is filled afterwards.
      (y - before[a]).store(next_differences[a] + at - lanes);
      before[a] = y;
    }
  }
  return std::sqrt(sum(squares));
}

/// The loop for a reach from 1 to most.
template <int most, Density D>
double sub_step_within(int reach, const D& density, const SubStepRows& rows) {
  if constexpr (most == 0) return 0;
  else return reach == most ? sub_step_loop<most>(density, rows) : sub_step_within<most - 1>(reach, density, rows);
}

}  // namespace delf
