// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "jets/density.hpp"
#include "jets/numbers/sinc.hpp"

namespace delf {

/// An abstract number: instead of a value it carries what can be proved of an expression from its form alone — on
/// which variables it depends, and which entries of its Hessian are not zero, or not constant. Running a density once
/// on it proves what sampling could only suggest.
struct Abstract {
  static constexpr int most_variables = 32;

  std::optional<double> constant = 0.0;                 ///< its value, when it depends on nothing
  std::uint32_t depends = 0;                            ///< bit a: the first derivative by variable a may be ≠ 0
  std::array<std::uint32_t, most_variables> nonzero{};  ///< bit b of [a]: ∂²/∂a∂b may be ≠ 0
  std::array<std::uint32_t, most_variables> varying{};  ///< bit b of [a]: ∂²/∂a∂b may depend on the variables
  double largest = 0;    ///< |value| is no more than this, NaN if nothing is known
  bool in_reach = true;  ///< and no function on the way to it has been asked beyond what the polynomials of packs reach

  Abstract() = default;
  Abstract(double c) : constant(c), largest(std::abs(c)) {}
  static Abstract variable(int a, double largest = std::numeric_limits<double>::infinity()) {
    Abstract x;
    x.constant.reset();
    x.depends = 1u << a;
    x.largest = largest;
    return x;
  }
  Abstract bounded(double bound, bool within_reach) const {
    Abstract r = *this;
    r.largest = bound, r.in_reach = within_reach;
    return r;
  }

  friend Abstract operator+(const Abstract& u, const Abstract& v) {
    return sum(u, v).bounded(u.largest + v.largest, u.in_reach && v.in_reach);
  }
  friend Abstract sum(const Abstract& u, const Abstract& v) {
    if (u.constant && v.constant) return *u.constant + *v.constant;
    Abstract r = u;
    r.constant.reset();
    r.depends |= v.depends;
    for (int a = 0; a < most_variables; ++a) r.nonzero[a] |= v.nonzero[a], r.varying[a] |= v.varying[a];
    return r;
  }
  friend Abstract operator-(const Abstract& u) {
    return u.constant ? Abstract(-*u.constant).bounded(u.largest, u.in_reach) : u;
  }
  friend Abstract operator-(const Abstract& u, const Abstract& v) { return u + (-v); }

  friend Abstract operator*(const Abstract& u, const Abstract& v) {
    const bool none = u.largest == 0 || v.largest == 0;
    return product(u, v).bounded(none ? 0 : u.largest * v.largest, u.in_reach && v.in_reach);
  }
  friend Abstract product(const Abstract& u, const Abstract& v) {
    if (u.constant && v.constant) return *u.constant * *v.constant;
    if (u.constant) return *u.constant == 0.0 ? Abstract(0.0) : v;
    if (v.constant) return *v.constant == 0.0 ? Abstract(0.0) : u;
    Abstract r;
    r.constant.reset();
    r.depends = u.depends | v.depends;
    // (uv)_ab = u_ab v + u_a v_b + u_b v_a + u v_ab: the outer terms vary with the other factor, the products of
    // first derivatives vary when one of those does, that is where its row of second derivatives is not zero.
    for (int a = 0; a < most_variables; ++a) {
      r.nonzero[a] |= u.nonzero[a] | v.nonzero[a];
      r.varying[a] |= u.nonzero[a] | v.nonzero[a];
      for (int b = 0; b < most_variables; ++b) {
        const auto first = [](const Abstract& w, int c) { return (w.depends >> c & 1u) != 0; };
        for (const auto& [p, q] : {std::pair{&u, &v}, std::pair{&v, &u}})
          if (first(*p, a) && first(*q, b)) {
            r.nonzero[a] |= 1u << b;
            if (p->nonzero[a] || q->nonzero[b]) r.varying[a] |= 1u << b;
          }
      }
    }
    return r;
  }

  /// f(u) for a function f of which nothing is known.
  friend Abstract unknown_function(const Abstract& u) {
    Abstract r;
    r.constant.reset();
    r.depends = u.depends;
    for (int a = 0; a < most_variables; ++a)
      if (u.depends >> a & 1u) r.nonzero[a] = r.varying[a] = u.depends;
    return r.bounded(std::numeric_limits<double>::quiet_NaN(), u.in_reach);
  }
  /// The same where f(u) is no more than `bound`, and packs have a polynomial for |u| ≤ `reach`.
  template <class Function>
  static Abstract function(const Abstract& u, Function f, double bound = std::numeric_limits<double>::quiet_NaN(),
                           double reach = std::numeric_limits<double>::infinity()) {
    const bool within_reach = reach == std::numeric_limits<double>::infinity() || u.largest <= reach;
    return (u.constant ? Abstract(f(*u.constant)) : unknown_function(u)).bounded(bound, u.in_reach && within_reach);
  }
  friend Abstract operator/(const Abstract& u, const Abstract& v) {
    if (v.constant) return u * Abstract(1.0 / *v.constant).bounded(std::abs(1.0 / *v.constant), v.in_reach);
    return u * unknown_function(v);
  }
  Abstract& operator+=(const Abstract& v) { return *this = *this + v; }
  Abstract& operator-=(const Abstract& v) { return *this = *this - v; }
  Abstract& operator*=(const Abstract& v) { return *this = *this * v; }

  friend Abstract sin(const Abstract& u) {
    return function(u, [](double x) { return std::sin(x); }, 1, detail::largest_reduced);
  }
  friend Abstract cos(const Abstract& u) {
    return function(u, [](double x) { return std::cos(x); }, 1, detail::largest_reduced);
  }
  friend Abstract cosm1(const Abstract& u) {
    return function(u, [](double x) { return delf::cosm1(x); }, 2, detail::largest_reduced);
  }
  friend Abstract tan(const Abstract& u) {
    return function(u, [](double x) { return std::tan(x); });
  }
  friend Abstract exp(const Abstract& u) {
    return function(u, [](double x) { return std::exp(x); }, std::exp(u.largest));
  }
  friend Abstract log(const Abstract& u) {
    return function(u, [](double x) { return std::log(x); });
  }
  friend Abstract sqrt(const Abstract& u) {
    return function(u, [](double x) { return std::sqrt(x); }, std::sqrt(u.largest));
  }
  friend Abstract sinh(const Abstract& u) {
    return function(u, [](double x) { return std::sinh(x); }, std::sinh(u.largest), detail::largest_hyperbolic);
  }
  friend Abstract cosh(const Abstract& u) {
    return function(u, [](double x) { return std::cosh(x); }, std::cosh(u.largest), detail::largest_hyperbolic);
  }
  friend Abstract tanh(const Abstract& u) {
    return function(u, [](double x) { return std::tanh(x); }, 1);
  }
  friend Abstract sinc(const Abstract& u) {
    return function(u, [](double x) { return delf::sinc(x); }, 1);
  }
  friend Abstract pow(const Abstract& u, double p) {
    if (p == 0) return Abstract(1.0).bounded(1, u.in_reach);
    if (p == 1) return u;
    if (p == 2) return u * u;
    const double bound = p > 0 ? std::pow(u.largest, p) : std::numeric_limits<double>::quiet_NaN();
    return function(u, [p](double x) { return std::pow(x, p); }, bound);
  }
};

/// Which components of the jet a density is nonlinear in.
enum class Nonlinearity {
  none,    ///< the gradient is linear in the jet with constant coefficients: bands say everything
  values,  ///< ∂ℓ/∂φ is anything, φ_t and φ_x enter linearly with constant coefficients
  all      ///< anything
};

/// What is proved of a density. Variables in the order φ¹ … φᵈ, φ_t¹ …, φ_x¹ …, then t, x.
struct DensityStructure {
  Nonlinearity nonlinearity = Nonlinearity::all;
  Abstract of_density;  ///< the density's own abstract value
};

template <Density D>
DensityStructure structure_of(const D& density) {
  constexpr int d = components_of<D>();
  static_assert(3 * d + 2 <= Abstract::most_variables, "delf: raise Abstract::most_variables for this many components");
  JetFor<Abstract, D> jet;
  for (int a = 0; a < d; ++a) {
    component(jet.phi, a) = Abstract::variable(a);
    component(jet.phi_t, a) = Abstract::variable(d + a);
    component(jet.phi_x, a) = Abstract::variable(2 * d + a);
  }
  if constexpr (is_placed<D>()) jet.t = Abstract::variable(3 * d), jet.x = Abstract::variable(3 * d + 1);
  DensityStructure s;
  s.of_density = density(jet);

  const std::uint32_t values = (1u << d) - 1, place = 3u << (3 * d);
  const std::uint32_t field = (1u << (3 * d)) - 1;
  bool beyond_values = false, any = false;
  for (int a = 0; a < 3 * d; ++a) {
    // The gradient's entry a is not an affine function of the jet if a second derivative varies or meets t or x.
    const std::uint32_t bad = (s.of_density.varying[a] & field) | (s.of_density.nonzero[a] & place);
    any = any || bad;
    beyond_values = beyond_values || (a >= d && bad) || (a < d && (bad & ~values & field));
  }
  s.nonlinearity = !any ? Nonlinearity::none : beyond_values ? Nonlinearity::all : Nonlinearity::values;
  return s;
}

/// The largest bound on |φ|, of 1, 10, …, 1e6 and 3e6, below which f(bound) is in reach of packs' polynomials; −1 if
/// none is.
template <class Function>
double bound_in_reach(const Function& f) {
  if (f(detail::largest_reduced).in_reach) return detail::largest_reduced;
  for (double bound = 1e6; bound >= 1; bound /= 10)
    if (f(bound).in_reach) return bound;
  return -1;
}

/// While |φ| is no more than this, ℓ(φ, 0, 0) and its derivative may be evaluated on NearPacks, at any t and x.
template <Density D>
double near_below(const D& density) {
  constexpr int d = components_of<D>();
  return bound_in_reach([&density](double bound) {
    JetFor<Abstract, D> jet;
    for (int a = 0; a < d; ++a) {
      component(jet.phi, a) = Abstract::variable(a, bound);
      component(jet.phi_t, a) = component(jet.phi_x, a) = Abstract(0.0);
    }
    if constexpr (is_placed<D>()) jet.t = Abstract::variable(d), jet.x = Abstract::variable(d + 1);
    return density(jet);
  });
}

}  // namespace delf
