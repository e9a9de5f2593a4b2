// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cmath>
#include <optional>

#include "jets/density.hpp"
#include "jets/simd/reduced_pack.hpp"
#include "jets/numbers/structure.hpp"
#include "schemes/families/row_kernel.hpp"

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

/// ℓ = Σ_a ½(inertia[a] (φ_t^a)² − tension[a] (φ_x^a)²) + ℓ(φ, 0, 0), as of most densities: energy is then made of
/// sums of squares and of ℓ at rest, and no derivative is needed.
template <int d>
struct WaveForm {
  std::array<double, static_cast<std::size_t>(d)> inertia{}, tension{};
};
/// Nothing for other densities, or where the coefficients are not finite.
template <Density D>
std::optional<WaveForm<components_of<D>()>> wave_form(const D& density) {
  constexpr int d = components_of<D>();
  const Abstract proved = structure_of(density).of_density;
  for (int a = d; a < 3 * d; ++a)  // φ_t^a or φ_x^a meets nothing but itself, with a constant coefficient
    if (proved.varying[a] != 0 || (proved.nonzero[a] & ~(1u << a)) != 0) return std::nullopt;
  using Inner = Dual<double, 2 * d>;
  using Number = Dual<Inner, 2 * d>;
  // The coefficients are the same at every jet; this is one where densities have values.
  JetFor<Number, D> jet;
  for (int a = 0; a < d; ++a) {
    component(jet.phi, a) = Number(Inner(1 + 0.25 * a));
    component(jet.phi_t, a) = Number::variable(Inner::variable(0, a), a);
    component(jet.phi_x, a) = Number::variable(Inner::variable(0, d + a), d + a);
  }
  if constexpr (is_placed<D>()) jet.t = Number(0.0), jet.x = Number(0.0);
  const Number l = density(jet);
  WaveForm<d> result;
  for (int a = 0; a < d; ++a) {
    result.inertia[a] = l.derivative(a).derivative(a);
    result.tension[a] = -l.derivative(d + a).derivative(d + a);
    // Neither may enter linearly as well; a NaN is not zero.
    if (!(l.derivative(a).value == 0 && l.derivative(d + a).value == 0)) return std::nullopt;
    if (!std::isfinite(result.inertia[a]) || !std::isfinite(result.tension[a])) return std::nullopt;
  }
  return result;
}

/// Which cells are counted: 1 for each slot that is the left end of one, else 0; in the packs before `whole` all are.
struct CellWeights {
  const double* row;
  int whole;
};

/// Energy and momentum between two rows j and j+1, over the symmetric rectangle's jets whatever the scheme:
///
///   H = k Σ (φ_t ∂ℓ/∂φ_t − ℓ)                 P = −k Σ φ_x ∂ℓ/∂φ_t
///
/// For sine-Gordon H is k times the sum of Marsden–Patrick–Shkoller's footnote 4. The lattice breaks the symmetries
/// behind both: they are measured, not conserved. rows.values: the d rows y_j, the d rows y_{j+1}, and d rows of what v =
/// y_{j+1} − y_j is without the rounding of a difference.
template <Density D>
[[gnu::__flatten__, gnu::__noclone__]] EnergyMomentum energy_momentum(const D& given, const SlabRows& rows,
                                                                      const CellWeights& weights) {
  constexpr int d = components_of<D>();
  using Number = Dual<Pack, d>;
  const D density = given;
  const double per_h = 0.5 / rows.time_step, per_k = 0.5 / rows.space_step;
  Pack energy(0.0), momentum(0.0);
  for (int v = 0; v < rows.layout->packs(); ++v) {
    const std::ptrdiff_t at = rows.layout->at(v);
    JetFor<Number, D> jet;
    std::array<Pack, static_cast<std::size_t>(d)> by_t, by_x;
    for (int a = 0; a < d; ++a) {
      const double *y = rows.values[a] + at, *step = rows.values[2 * d + a] + at;
      const Pack y_0 = Pack::load(y), y_1 = Pack::load(y + lanes);
      const Pack v_0 = Pack::load(step), v_1 = Pack::load(step + lanes);
      by_t[a] = per_h * (v_0 + v_1);
      by_x[a] = per_k * (2.0 * (y_1 - y_0) + (v_1 - v_0));
      component(jet.phi, a) = Number(0.5 * (y_0 + y_1) + 0.25 * (v_0 + v_1));
      component(jet.phi_t, a) = Number::variable(by_t[a], a);
      component(jet.phi_x, a) = Number(by_x[a]);
    }
    if constexpr (is_placed<D>()) {
      jet.t = Number(Pack(rows.t + 0.5 * rows.time_step));
      jet.x = Number(Pack::load(rows.positions + at) + 0.5 * rows.space_step);
    }
    const Number l = density(jet);
    Pack h = -l.value, p(0.0);
    for (int a = 0; a < d; ++a) h += by_t[a] * l.derivative(a), p -= by_x[a] * l.derivative(a);
    const Pack weight = Pack::load(weights.row + at);
    energy += weight * h;
    momentum += weight * p;
  }
  return {rows.space_step * sum(energy), rows.space_step * sum(momentum)};
}

/// The same for a density with a wave form. With the sums s = y_j + y_{j+1} of the two rows,
///
///     φ = (s_i + s_{i+1})/4        φ_t = (v_i + v_{i+1})/(2h)        φ_x = (s_{i+1} − s_i)/(2k)
///
///   H = k Σ (½ inertia φ_t² + ½ tension φ_x² − ℓ(φ, 0, 0))           P = −k Σ inertia φ_t φ_x
///
/// `Value`: what ℓ is evaluated on; ReducedPack if the rows are near.
template <class Value, Density D>
[[gnu::__flatten__, gnu::__noclone__]] EnergyMomentum energy_momentum(const D& given,
                                                                      const WaveForm<components_of<D>()>& form,
                                                                      const SlabRows& given_rows,
                                                                      const CellWeights& weights) {
  constexpr int d = components_of<D>();
  // Copies of this function alone, which stay in registers.
  const D density = given;
  std::array<const double*, static_cast<std::size_t>(d)> before, after, increment;
  for (int a = 0; a < d; ++a)
    before[a] = given_rows.values[a], after[a] = given_rows.values[d + a], increment[a] = given_rows.values[2 * d + a];
  const double* const positions = given_rows.positions;
  const Pack t(given_rows.t + 0.5 * given_rows.time_step);
  const double x_offset = 0.5 * given_rows.space_step;

  struct AtSite {
    Pack v, both;  ///< both: s
  };
  struct Sums {
    Pack tt = 0.0, xx = 0.0, tx = 0.0;
  };
  std::array<AtSite, static_cast<std::size_t>(d)> left;
  std::array<Sums, static_cast<std::size_t>(d)> sums;
  Pack at_rest(0.0);
  const auto load = [&](int a, std::ptrdiff_t at) __attribute__((always_inline)) {
    const Pack v = Pack::load(increment[a] + at), y = Pack::load(before[a] + at);
    return AtSite{v, y + Pack::load(after[a] + at)};
  };
  // φ of the next cells, which count by what `weigh` makes of them.
  using Values = std::array<Pack, static_cast<std::size_t>(d)>;
  const auto find = [&](std::ptrdiff_t at, const auto& weigh) __attribute__((always_inline)) {
    Values phi;
    for (int a = 0; a < d; ++a) {
      const AtSite right = load(a, at + lanes);
      const Pack by_t = left[a].v + right.v, by_x = right.both - left[a].both;
      sums[a].tt += weigh(by_t) * by_t;
      sums[a].xx += weigh(by_x) * by_x;
      sums[a].tx += weigh(by_t) * by_x;
      phi[a] = 0.25 * (left[a].both + right.both);
      left[a] = right;
    }
    return phi;
  };
  using Begun = std::array<Value, static_cast<std::size_t>(d)>;
  const auto begin = [](const Values& phi) __attribute__((always_inline)) {
    Begun values;
    for (int a = 0; a < d; ++a) values[a] = phi[a];
    return values;
  };
  const auto rest = [&](std::ptrdiff_t at, const Begun& phi) __attribute__((always_inline)) {
    JetFor<Value, D> jet;
    for (int a = 0; a < d; ++a) {
      component(jet.phi, a) = phi[a];
      component(jet.phi_t, a) = 0.0;
      component(jet.phi_x, a) = 0.0;
    }
    if constexpr (is_placed<D>()) jet.t = t, jet.x = Pack::load(positions + at) + x_offset;
    return Pack(density(jet));
  };
  const auto all = [](Pack x) __attribute__((always_inline)) { return x; };
  const RowLayout& layout = *given_rows.layout;
  std::ptrdiff_t at = layout.at(0);
  const std::ptrdiff_t whole = layout.at(weights.whole), end = layout.at(layout.packs());
  for (int a = 0; a < d; ++a) left[a] = load(a, at);
  // φ is found two packs ahead, as arguments are in argument_loop(), and its sine is begun one ahead.
  if (at + lanes < whole) {
    Begun here = begin(find(at, all));
    Values next = find(at + lanes, all);
    for (; at + 2 * lanes < whole; at += lanes) {
      const Values ahead = find(at + 2 * lanes, all);
      const Pack resting = rest(at, here);
      here = begin(next), next = ahead;
      at_rest += resting;
    }
    at_rest += rest(at, here) + rest(at + lanes, begin(next));
    at += 2 * lanes;
  }
  for (; at < end; at += lanes) {
    const auto weigh = [weight = Pack::load(weights.row + at)](Pack x)
                           __attribute__((always_inline)) { return weight * x; };
    const Begun phi = begin(find(at, weigh));
    at_rest += weigh(rest(at, phi));
  }

  const double per_h = 0.5 / given_rows.time_step, per_k = 0.5 / given_rows.space_step;
  Pack energy = -at_rest, momentum(0.0);
  for (int a = 0; a < d; ++a) {
    energy += 0.5 * form.inertia[a] * per_h * per_h * sums[a].tt + 0.5 * form.tension[a] * per_k * per_k * sums[a].xx;
    momentum -= form.inertia[a] * per_h * per_k * sums[a].tx;
  }
  return {given_rows.space_step * sum(energy), given_rows.space_step * sum(momentum)};
}

}  // namespace delf
