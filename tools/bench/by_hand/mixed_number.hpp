// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <utility>

#include "jets/simd/pack_math.hpp"

namespace delf::bench {

/// body(0), …, body(n − 1) with constant arguments.
template <int n, class F>
[[gnu::always_inline]] inline constexpr void each(F&& body) {
  [&]<int... i>(std::integer_sequence<int, i...>) __attribute__((always_inline)) {
    (body(std::integral_constant<int, i>{}), ...);
  }
  (std::make_integer_sequence<int, n>{});
}

/// A function with its slope and its curvature.
struct Three {
  Pack f, f1, f2;
};
[[gnu::always_inline]] inline Three cosine(Pack x) {
  const Pack c = cos(x), s = sin(x);
  return {c, -s, -c};
}
/// sinc x = sin x / x: from sin x = x + x³S(x²) and cos x = 1 + x²C(x²), for |x| < 1.57.
[[gnu::always_inline]] inline Three sinc_near_zero(Pack x) {
  const Pack s = x * x, S = detail::sine_cubic_part(s), C = detail::cosine_square_part(s), d = C - S;
  return {s * S + 1.0, x * d, -1.0 - s * S - 2.0 * d};
}

/// A pack of numbers with its derivatives by `ne` values that have equations, by `nu` unknowns, and the mixed second
/// ones: all that the residual and the Jacobian of a slab need, in one evaluation.
template <int ne, int nu>
struct Mixed {
  Pack v, e[ne ? ne : 1], u[nu ? nu : 1], m[ne * nu ? ne * nu : 1];

  Mixed() = default;
  [[gnu::always_inline]] Mixed(Pack x) : v(x) {
    each<ne>([&](auto i) { e[i] = Pack(0.0); });
    each<nu>([&](auto j) { u[j] = Pack(0.0); });
    each<ne * nu>([&](auto k) { m[k] = Pack(0.0); });
  }
  /// `of` on every entry.
  template <class F>
  [[gnu::always_inline]] static Mixed by_entries(F&& of) {
    Mixed r;
    r.v = of([](const Mixed& a) -> const Pack& { return a.v; });
    each<ne>([&](auto i) { r.e[i] = of([i](const Mixed& a) -> const Pack& { return a.e[i]; }); });
    each<nu>([&](auto j) { r.u[j] = of([j](const Mixed& a) -> const Pack& { return a.u[j]; }); });
    each<ne * nu>([&](auto k) { r.m[k] = of([k](const Mixed& a) -> const Pack& { return a.m[k]; }); });
    return r;
  }
  [[gnu::always_inline]] friend Mixed operator+(const Mixed& a, const Mixed& b) {
    return by_entries([&](auto get) { return get(a) + get(b); });
  }
  [[gnu::always_inline]] friend Mixed operator-(const Mixed& a, const Mixed& b) {
    return by_entries([&](auto get) { return get(a) - get(b); });
  }
  [[gnu::always_inline]] friend Mixed operator*(double b, const Mixed& a) {
    return by_entries([&](auto get) { return b * get(a); });
  }
  [[gnu::always_inline]] friend Mixed operator-(const Mixed& a) {
    return by_entries([&](auto get) { return -get(a); });
  }
  [[gnu::always_inline]] friend Mixed operator-(double c, const Mixed& a) {
    Mixed r = -a;
    r.v = c - a.v;
    return r;
  }
  [[gnu::always_inline]] friend Mixed operator-(Mixed a, double c) {
    a.v = a.v - c;
    return a;
  }
  [[gnu::always_inline]] friend Mixed operator*(const Mixed& a, const Mixed& b) {
    Mixed r = by_entries([&](auto get) { return get(a) * b.v + a.v * get(b); });
    r.v = a.v * b.v;
    each<ne>([&](auto i) { each<nu>([&](auto j) { r.m[i * nu + j] += a.e[i] * b.u[j] + a.u[j] * b.e[i]; }); });
    return r;
  }
  /// f(a)
  [[gnu::always_inline]] friend Mixed chain(const Mixed& a, const Three& f) {
    Mixed r = by_entries([&](auto get) { return f.f1 * get(a); });
    r.v = f.f;
    each<ne>([&](auto i) {
      const Pack by = f.f2 * a.e[i];
      each<nu>([&](auto j) { r.m[i * nu + j] += by * a.u[j]; });
    });
    return r;
  }
  [[gnu::always_inline]] friend Mixed operator/(const Mixed& a, const Mixed& b) {
    const Pack i = Pack(1.0) / b.v, i2 = i * i;
    return a * chain(b, {i, -i2, 2.0 * i * i2});
  }
  [[gnu::always_inline]] friend Mixed cos(const Mixed& a) { return chain(a, cosine(a.v)); }
  [[gnu::always_inline]] friend Mixed sinc_near_zero(const Mixed& a) { return chain(a, sinc_near_zero(a.v)); }
};

}  // namespace delf::bench
