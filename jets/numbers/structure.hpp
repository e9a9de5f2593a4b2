// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "jets/density.hpp"
#include "jets/numbers/sinc.hpp"

namespace delf {

/// A change of sign of jets: of one slot, or of every derivative of odd order in t.
enum class Reflection { phi, phi_t, phi_x, phi_tt, phi_tx, phi_xx, in_time };

/// An abstract number: instead of a value it carries what can be proved of an expression from its form alone — on
/// which variables it depends, and which entries of its Hessian are not zero, or not constant. Running a density once
/// on it proves what sampling could only suggest.
struct Abstract {
  static constexpr int most_variables = 64;
  static constexpr std::uint8_t all_reflections = 0x7f;

  std::optional<double> constant = 0.0;                 ///< its value, when it depends on nothing
  std::uint64_t depends = 0;                            ///< bit a: the first derivative by variable a may be ≠ 0
  std::array<std::uint64_t, most_variables> nonzero{};  ///< bit b of [a]: ∂²/∂a∂b may be ≠ 0
  std::array<std::uint64_t, most_variables> varying{};  ///< bit b of [a]: ∂²/∂a∂b may depend on the variables
  std::uint8_t even = 0, odd = 0;  ///< bit r: reflection r is proved to leave it as it is, or to change its sign

  Abstract() = default;
  Abstract(double c) : constant(c), even(all_reflections), odd(c == 0.0 ? all_reflections : 0) {}
  static Abstract variable(int a) {
    Abstract x;
    x.constant.reset();
    x.depends = std::uint64_t{1} << a;
    return x;
  }
  /// A variable of slot s of a jet; none: a coordinate.
  static Abstract variable(int a, std::optional<int> s) {
    Abstract x = variable(a);
    const auto bit = [](Reflection r) { return 1u << static_cast<int>(r); };
    const bool with_time = s && (*s == static_cast<int>(Reflection::phi_t) || *s == static_cast<int>(Reflection::phi_tx));
    if (s) x.odd = static_cast<std::uint8_t>(1u << *s | (with_time ? bit(Reflection::in_time) : 0u));
    x.even = static_cast<std::uint8_t>(all_reflections & ~x.odd);
    return x;
  }
  friend Abstract operator+(const Abstract& u, const Abstract& v) {
    if (u.constant && v.constant) return *u.constant + *v.constant;
    Abstract r = u;
    r.constant.reset();
    r.depends |= v.depends;
    r.even &= v.even, r.odd &= v.odd;
    for (int a = 0; a < most_variables; ++a) r.nonzero[a] |= v.nonzero[a], r.varying[a] |= v.varying[a];
    return r;
  }
  friend Abstract operator-(const Abstract& u) { return u.constant ? Abstract(-*u.constant) : u; }
  friend Abstract operator-(const Abstract& u, const Abstract& v) { return u + (-v); }

  friend Abstract operator*(const Abstract& u, const Abstract& v) {
    if (u.constant && v.constant) return *u.constant * *v.constant;
    if (u.constant) return *u.constant == 0.0 ? Abstract(0.0) : v;
    if (v.constant) return *v.constant == 0.0 ? Abstract(0.0) : u;
    Abstract r;
    r.constant.reset();
    r.depends = u.depends | v.depends;
    r.even = static_cast<std::uint8_t>((u.even & v.even) | (u.odd & v.odd));
    r.odd = static_cast<std::uint8_t>((u.even & v.odd) | (u.odd & v.even));
    // (uv)_ab = u_ab v + u_a v_b + u_b v_a + u v_ab: the outer terms vary with the other factor, the products of
    // first derivatives vary when one of those does, that is where its row of second derivatives is not zero.
    const int variables = static_cast<int>(std::bit_width(r.depends));
    for (int a = 0; a < variables; ++a) {
      r.nonzero[a] |= u.nonzero[a] | v.nonzero[a];
      r.varying[a] |= u.nonzero[a] | v.nonzero[a];
      for (int b = 0; b < variables; ++b) {
        const auto first = [](const Abstract& w, int c) { return (w.depends >> c & 1) != 0; };
        for (const auto& [p, q] : {std::pair{&u, &v}, std::pair{&v, &u}})
          if (first(*p, a) && first(*q, b)) {
            r.nonzero[a] |= std::uint64_t{1} << b;
            if (p->nonzero[a] || q->nonzero[b]) r.varying[a] |= std::uint64_t{1} << b;
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
    r.even = u.even;
    for (int a = 0; a < most_variables; ++a)
      if (u.depends >> a & 1) r.nonzero[a] = r.varying[a] = u.depends;
    return r;
  }
  template <class Function>
  static Abstract function(const Abstract& u, Function f) {
    return u.constant ? Abstract(f(*u.constant)) : unknown_function(u);
  }
  template <class Function>
  static Abstract even_function(const Abstract& u, Function f) {
    Abstract r = function(u, f);
    return r.even |= u.odd, r;
  }
  template <class Function>
  static Abstract odd_function(const Abstract& u, Function f) {
    Abstract r = function(u, f);
    return r.odd |= u.odd, r;
  }
  friend Abstract operator/(const Abstract& u, const Abstract& v) {
    if (v.constant) return u * Abstract(1.0 / *v.constant);
    return u * odd_function(v, [](double x) { return 1 / x; });
  }
  Abstract& operator+=(const Abstract& v) { return *this = *this + v; }
  Abstract& operator-=(const Abstract& v) { return *this = *this - v; }
  Abstract& operator*=(const Abstract& v) { return *this = *this * v; }

  friend Abstract sin(const Abstract& u) {
    return odd_function(u, [](double x) { return std::sin(x); });
  }
  friend Abstract cos(const Abstract& u) {
    return even_function(u, [](double x) { return std::cos(x); });
  }
  friend Abstract cosm1(const Abstract& u) {
    return even_function(u, [](double x) { return delf::cosm1(x); });
  }
  friend Abstract tan(const Abstract& u) {
    return odd_function(u, [](double x) { return std::tan(x); });
  }
  friend Abstract exp(const Abstract& u) {
    return function(u, [](double x) { return std::exp(x); });
  }
  friend Abstract log(const Abstract& u) {
    return function(u, [](double x) { return std::log(x); });
  }
  friend Abstract sqrt(const Abstract& u) {
    return function(u, [](double x) { return std::sqrt(x); });
  }
  friend Abstract sinh(const Abstract& u) {
    return odd_function(u, [](double x) { return std::sinh(x); });
  }
  friend Abstract cosh(const Abstract& u) {
    return even_function(u, [](double x) { return std::cosh(x); });
  }
  friend Abstract tanh(const Abstract& u) {
    return odd_function(u, [](double x) { return std::tanh(x); });
  }
  friend Abstract atan(const Abstract& u) {
    return odd_function(u, [](double x) { return std::atan(x); });
  }
  friend Abstract sinc(const Abstract& u) {
    return even_function(u, [](double x) { return delf::sinc(x); });
  }
  friend Abstract pow(const Abstract& u, double p) {
    if (p == 0) return Abstract(1.0);
    if (p == 1) return u;
    if (p == 2) return u * u;
    if (p == std::trunc(p)) {
      const auto power = [p](double x) { return std::pow(x, p); };
      return std::fmod(p, 2) == 0 ? even_function(u, power) : odd_function(u, power);
    }
    return function(u, [p](double x) { return std::pow(x, p); });
  }
};

/// The components of the jet in which a density is nonlinear.
enum class Nonlinearity {
  none,    ///< the gradient is linear in the jet with constant coefficients: bands say everything
  values,  ///< ∂ℓ/∂φ is anything, φ_t and φ_x enter linearly with constant coefficients
  all      ///< anything
};

/// The structure proved of a density. Variables in the order of slots, φ¹ … φᵈ, φ_t¹ …, φ_x¹ …, then t, x.
struct DensityStructure {
  Nonlinearity nonlinearity = Nonlinearity::all;
  Abstract of_density;  ///< the density's own abstract value
};

/// The structure of a density of m variables, d of them values, from its abstract value.
inline DensityStructure structure_of(const Abstract& density, int m, int d) {
  DensityStructure s;
  s.of_density = density;
  // A density is even in what it does not depend on.
  for (int r = 0; r < 7; ++r) {
    bool read = false;
    for (int a = 0; a < m; ++a) {
      const bool reflected = (Abstract::variable(a, a / d).odd >> r & 1) != 0;
      read = read || (reflected && (density.depends >> a & 1) != 0);
    }
    if (!read) s.of_density.even |= static_cast<std::uint8_t>(1u << r);
  }
  const auto lowest = [](int bits) { return (std::uint64_t{1} << bits) - 1; };
  const std::uint64_t values = lowest(d), field = lowest(m), place = lowest(m + 2) & ~field;
  bool beyond_values = false, any = false;
  for (int a = 0; a < m; ++a) {
    // The gradient's entry a is not an affine function of the jet if a second derivative varies or meets t or x.
    const std::uint64_t bad = (s.of_density.varying[a] & field) | (s.of_density.nonzero[a] & place);
    any = any || bad;
    beyond_values = beyond_values || (a >= d && bad) || (a < d && (bad & ~values & field));
  }
  s.nonlinearity = !any ? Nonlinearity::none : beyond_values ? Nonlinearity::all : Nonlinearity::values;
  return s;
}

template <Density D>
DensityStructure structure_of(const D& density) {
  constexpr int d = components_of<D>(), m = slots_of<D>() * d;
  static_assert(m + 2 <= Abstract::most_variables, "delf: raise Abstract::most_variables for this many components");
  JetFor<Abstract, D> jet;
  for (int s = 0; s < slots_of<D>(); ++s)
    for (int a = 0; a < d; ++a) jet_slot(jet, s, a) = Abstract::variable(s * d + a, s);
  if constexpr (is_placed<D>())
    jet.t = Abstract::variable(m, std::nullopt), jet.x = Abstract::variable(m + 1, std::nullopt);
  return structure_of(density(jet), m, d);
}

}  // namespace delf
