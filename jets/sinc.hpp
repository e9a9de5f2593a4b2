// SPDX-License-Identifier: MIT
#pragma once
#include "jets/dual.hpp"

namespace delf {

namespace detail {
/// Below this the series is used; its first neglected term is 4e-19.
inline constexpr double sinc_series_below = 0.25;
template <class T>
T sinc_series(T s) {  // s = x²:  1 − s/3! + s²/5! − …
  return 1.0 + s * (-1. / 6 + s * (1. / 120 + s * (-1. / 5040 + s * (1. / 362880 + s * (-1. / 39916800)))));
}
template <class T>
T sinc_slope_series(T x, T s) {  // −x/3 + x³/30 − x⁵/840 + …
  return x *
         (-1. / 3 + s * (1. / 30 + s * (-1. / 840 + s * (1. / 45360 + s * (-1. / 3991680 + s * (1. / 518918400))))));
}
}  // namespace detail

/// sin(x)/x, with its value 1 and its derivative 0 at x = 0.
inline double sinc(double x) {
  return std::abs(x) < detail::sinc_series_below ? detail::sinc_series(x * x) : std::sin(x) / x;
}
inline Pack sinc(Pack x) {
  const Pack quotient = sin(x) / x, series = detail::sinc_series(x * x);
  return {abs(x).v < detail::sinc_series_below ? series.v : quotient.v};
}

/// d sinc/dx = (cos x − sinc x)/x
inline double sinc_slope(double x) {
  return std::abs(x) < detail::sinc_series_below ? detail::sinc_slope_series(x, x * x)
                                                 : (std::cos(x) - std::sin(x) / x) / x;
}
inline Pack sinc_slope(Pack x) {
  const Pack quotient = (cos(x) - sin(x) / x) / x, series = detail::sinc_slope_series(x, x * x);
  return {abs(x).v < detail::sinc_series_below ? series.v : quotient.v};
}

/// d² sinc/dx² = −sinc x − 2 (d sinc/dx)/x
inline double sinc_curvature(double x) {
  const double s = x * x;
  if (std::abs(x) >= detail::sinc_series_below) return -sinc(x) - 2 * sinc_slope(x) / x;
  return -1. / 3 + s * (1. / 10 + s * (-1. / 168 + s * (1. / 6480 + s * (-1. / 443520 + s * (1. / 47174400)))));
}
inline Pack sinc_curvature(Pack x) {
  return detail::by_lane(x, [](double y) { return sinc_curvature(y); });
}
/// What a Hessian by Dual of Dual needs.
template <class T, int n>
Dual<T, n> sinc_slope(const Dual<T, n>& u) {
  return chain(u, sinc_slope(u.value), sinc_curvature(u.value));
}

template <class T, int n>
Dual<T, n> sinc(const Dual<T, n>& u) {
  return chain(u, sinc(u.value), sinc_slope(u.value));
}

}  // namespace delf
