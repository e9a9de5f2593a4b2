// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cmath>
#include <optional>
#include <type_traits>

#include "jets/density.hpp"
#include "jets/structure.hpp"
#include "schemes/row_kernel.hpp"

namespace delf {

struct EnergyMomentum {
  double energy = 0, momentum = 0;
};

/// What flows where at a jet: for the balance laws of translations in time and in space,
///
///     ∂_t(φ_t ∂ℓ/∂φ_t − ℓ) + ∂_x(φ_t ∂ℓ/∂φ_x) = −∂ℓ/∂t        ∂_t(−φ_x ∂ℓ/∂φ_t) + ∂_x(ℓ − φ_x ∂ℓ/∂φ_x) = ∂ℓ/∂x
///
/// whose right-hand sides are there only for densities that depend on t and x themselves.
struct StressEnergy {
  double energy = 0, energy_flux = 0, momentum = 0, momentum_flux = 0;  ///< the four terms, without their derivatives
  double by_t = 0, by_x = 0;                                            ///< ∂ℓ/∂t and ∂ℓ/∂x
};
/// `phi`, `phi_t`, `phi_x`: d numbers each.
template <Density D>
StressEnergy stress_energy(const D& density, const double* phi, const double* phi_t, const double* phi_x, double t,
                           double x) {
  constexpr int d = components_of<D>();
  using Number = Dual<double, 2 * d + 2>;
  JetFor<Number, D> jet;
  for (int a = 0; a < d; ++a) {
    component(jet.phi, a) = Number(phi[a]);
    component(jet.phi_t, a) = Number::variable(phi_t[a], a);
    component(jet.phi_x, a) = Number::variable(phi_x[a], d + a);
  }
  if constexpr (is_placed<D>()) {
    jet.t = Number::variable(t, 2 * d);
    jet.x = Number::variable(x, 2 * d + 1);
  }
  const Number l = density(jet);
  StressEnergy s{-l.value, 0, 0, l.value, l.derivative(2 * d), l.derivative(2 * d + 1)};
  for (int a = 0; a < d; ++a) {
    s.energy += phi_t[a] * l.derivative(a);
    s.energy_flux += phi_t[a] * l.derivative(d + a);
    s.momentum -= phi_x[a] * l.derivative(a);
    s.momentum_flux -= phi_x[a] * l.derivative(d + a);
  }
  return s;
}

/// ∂ℓ/∂φ_t where it is an affine function of the jet with constant coefficients, as for every density that is not
/// nonlinear in its derivatives: then a jet's energy needs ℓ itself, and no derivative.
///
///     ∂ℓ/∂φ_t^a = at_rest[a] + Σ_b by_jet[a][b] j_b,      j = φ¹ … φᵈ, φ_t¹ …, φ_x¹ …
template <int d>
struct AffineMomenta {
  std::array<double, static_cast<std::size_t>(d)> at_rest{};
  std::array<std::array<double, static_cast<std::size_t>(3 * d)>, static_cast<std::size_t>(d)> by_jet{};
};
/// Nothing for other densities, or where the coefficients are not finite.
template <Density D>
std::optional<AffineMomenta<components_of<D>()>> affine_momenta(const D& density) {
  constexpr int d = components_of<D>();
  if (structure_of(density).nonlinearity == Nonlinearity::all) return std::nullopt;
  using Inner = Dual<double, 3 * d>;
  using Number = Dual<Inner, 3 * d>;
  // The coefficients are the same at every jet; this is one where densities have values.
  JetFor<Number, D> jet;
  std::array<double, static_cast<std::size_t>(3 * d)> at{};
  for (int a = 0; a < d; ++a) at[a] = 1 + 0.25 * a;
  for (int a = 0; a < d; ++a) {
    component(jet.phi, a) = Number::variable(Inner::variable(at[a], a), a);
    component(jet.phi_t, a) = Number::variable(Inner::variable(0, d + a), d + a);
    component(jet.phi_x, a) = Number::variable(Inner::variable(0, 2 * d + a), 2 * d + a);
  }
  if constexpr (is_placed<D>()) jet.t = Number(0.0), jet.x = Number(0.0);
  const Number l = density(jet);
  AffineMomenta<d> result;
  for (int a = 0; a < d; ++a) {
    result.at_rest[a] = l.derivative(d + a).value;
    for (int b = 0; b < 3 * d; ++b) {
      result.by_jet[a][b] = l.derivative(d + a).derivative(b);
      result.at_rest[a] -= result.by_jet[a][b] * at[b];
    }
    if (!std::isfinite(result.at_rest[a])) return std::nullopt;
  }
  return result;
}

/// Energy and momentum between two rows j and j+1, over the symmetric rectangle's jets whatever the scheme:
///
///   H = k Σ (φ_t ∂ℓ/∂φ_t − ℓ)                 P = −k Σ φ_x ∂ℓ/∂φ_t
///
/// For sine-Gordon H is k times the sum of Marsden–Patrick–Shkoller's footnote 4. The lattice breaks the symmetries
/// behind both: they are measured, not conserved. rows.values: d rows at time j, then d rows of y_{j+1} − y_j;
/// weights: 1 for each slot that is counted as the left end of a cell, else 0.
///
/// `affine`: affine_momenta(density), or null.
template <Density D>
[[gnu::flatten]] EnergyMomentum energy_momentum(const D& given, const AffineMomenta<components_of<D>()>* affine,
                                                const SlabRows& rows, const double* weights) {
  constexpr int d = components_of<D>();
  const D density = given;
  const double per_h = 0.5 / rows.time_step, per_k = 0.5 / rows.space_step;
  const auto sums = [&]<class Number>(const auto& with_derivatives) __attribute__((always_inline)) {
    Pack energy(0.0), momentum(0.0);
    for (int v = 0; v < rows.layout->packs(); ++v) {
      const std::ptrdiff_t at = rows.layout->at(v);
      JetFor<Number, D> jet;
      std::array<Pack, static_cast<std::size_t>(d)> phi, by_t, by_x;
      for (int a = 0; a < d; ++a) {
        const double *y = rows.values[a] + at, *step = rows.values[d + a] + at;
        const Pack y_0 = Pack::load(y), y_1 = Pack::load(y + lanes);
        const Pack v_0 = Pack::load(step), v_1 = Pack::load(step + lanes);
        phi[a] = 0.5 * (y_0 + y_1) + 0.25 * (v_0 + v_1);
        by_t[a] = per_h * (v_0 + v_1);
        by_x[a] = per_k * (2.0 * (y_1 - y_0) + (v_1 - v_0));
        component(jet.phi, a) = Number(phi[a]);
        if constexpr (with_derivatives.value) component(jet.phi_t, a) = Number::variable(by_t[a], a);
        else component(jet.phi_t, a) = by_t[a];
        component(jet.phi_x, a) = Number(by_x[a]);
      }
      if constexpr (is_placed<D>()) {
        jet.t = Number(Pack(rows.t + 0.5 * rows.time_step));
        jet.x = Number(Pack::load(rows.positions + at) + 0.5 * rows.space_step);
      }
      const Number l = density(jet);
      Pack h(0.0), p(0.0);
      for (int a = 0; a < d; ++a) {
        Pack momenta(0.0);
        if constexpr (with_derivatives.value) {
          momenta = l.derivative(a);
        } else {
          momenta = affine->at_rest[a];
          for (int b = 0; b < d; ++b)
            momenta += affine->by_jet[a][b] * phi[b] + affine->by_jet[a][d + b] * by_t[b] +
                       affine->by_jet[a][2 * d + b] * by_x[b];
        }
        h += by_t[a] * momenta;
        p -= by_x[a] * momenta;
      }
      if constexpr (with_derivatives.value) h -= l.value;
      else h -= l;
      const Pack weight = Pack::load(weights + at);
      energy += weight * h;
      momentum += weight * p;
    }
    return EnergyMomentum{rows.space_step * sum(energy), rows.space_step * sum(momentum)};
  };
  if (affine) return sums.template operator()<Pack>(std::false_type{});
  return sums.template operator()<Dual<Pack, d>>(std::true_type{});
}

}  // namespace delf
