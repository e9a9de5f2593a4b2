// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cmath>
#include <concepts>
#include <type_traits>

#include "jets/simd/pack_math.hpp"
#include "lattice/index.hpp"

namespace delf {

/// A number that carries its derivatives with respect to n variables: forward differentiation. T is double, a Pack of
/// sites, or again a Dual, whose derivatives of derivatives are the Hessian.
template <class T, int n>
struct Dual {
  T value{};
  std::array<T, at(n)> d{};

  Dual() = default;
  constexpr Dual(double x) : value(x) { d.fill(T(0.0)); }
  constexpr Dual(T x) requires(!std::same_as<T, double>) : value(x) { d.fill(T(0.0)); }
  /// The variable number `which`.
  static constexpr Dual variable(T x, int which) {
    Dual y(x);
    y.d[which] = T(1.0);
    return y;
  }
  const T& derivative(int which) const { return d[which]; }

  /// f(u) by the chain rule, given f(u.value) and f′(u.value).
  friend Dual chain(const Dual& u, const T& f, const T& slope) {
    Dual r;
    r.value = f;
    for (int i = 0; i < n; ++i) r.d[i] = slope * u.d[i];
    return r;
  }

  friend Dual operator+(const Dual& a, const Dual& b) {
    Dual r;
    r.value = a.value + b.value;
    for (int i = 0; i < n; ++i) r.d[i] = a.d[i] + b.d[i];
    return r;
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    Dual r;
    r.value = a.value - b.value;
    for (int i = 0; i < n; ++i) r.d[i] = a.d[i] - b.d[i];
    return r;
  }
  friend Dual operator*(const Dual& a, const Dual& b) {
    Dual r;
    r.value = a.value * b.value;
    for (int i = 0; i < n; ++i) r.d[i] = a.d[i] * b.value + a.value * b.d[i];
    return r;
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const T inverse = T(1.0) / b.value;
    Dual r;
    r.value = a.value * inverse;
    for (int i = 0; i < n; ++i) r.d[i] = (a.d[i] - r.value * b.d[i]) * inverse;
    return r;
  }
  // A plain number touches no derivatives that it need not.
  friend Dual operator+(Dual a, double b) {
    a.value = a.value + T(b);
    return a;
  }
  friend Dual operator+(double a, Dual b) {
    b.value = T(a) + b.value;
    return b;
  }
  friend Dual operator-(Dual a, double b) {
    a.value = a.value - T(b);
    return a;
  }
  friend Dual operator-(double a, const Dual& b) { return a + (-b); }
  friend Dual operator*(const Dual& a, double b) { return chain(a, a.value * T(b), T(b)); }
  friend Dual operator*(double a, const Dual& b) { return b * a; }
  friend Dual operator/(const Dual& a, double b) { return a * (1.0 / b); }
  friend Dual operator/(double a, const Dual& b) { return Dual(a) / b; }
  friend Dual operator-(const Dual& a) {
    Dual r;
    r.value = -a.value;
    for (int i = 0; i < n; ++i) r.d[i] = -a.d[i];
    return r;
  }
  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }

  friend Dual sin(const Dual& u) { return chain(u, sin(u.value), cosine_beside_sine(u.value)); }
  friend Dual cos(const Dual& u) { return chain(u, cos(u.value), -sin(u.value)); }
  friend Dual cosm1(const Dual& u) { return chain(u, cosm1(u.value), -sin(u.value)); }
  friend Dual tan(const Dual& u) {
    const T t = tan(u.value);
    return chain(u, t, T(1.0) + t * t);
  }
  friend Dual exp(const Dual& u) {
    const T e = exp(u.value);
    return chain(u, e, e);
  }
  friend Dual log(const Dual& u) { return chain(u, log(u.value), T(1.0) / u.value); }
  friend Dual sqrt(const Dual& u) {
    const T s = sqrt(u.value);
    return chain(u, s, T(0.5) / s);
  }
  friend Dual sinh(const Dual& u) { return chain(u, sinh(u.value), cosh(u.value)); }
  friend Dual cosh(const Dual& u) { return chain(u, cosh(u.value), sinh(u.value)); }
  friend Dual tanh(const Dual& u) {
    const T t = tanh(u.value);
    return chain(u, t, T(1.0) - t * t);
  }
  friend Dual atan(const Dual& u) { return chain(u, atan(u.value), T(1.0) / (T(1.0) + u.value * u.value)); }
  friend Dual pow(const Dual& u, double p) {
    if (p == 0) return Dual(1.0);  // u⁰ is a constant, at 0 too
    return chain(u, pow(u.value, p), T(p) * pow(u.value, p - 1.0));
  }
};

}  // namespace delf
