// SPDX-License-Identifier: MIT
#pragma once
#include "jets/numbers/dual.hpp"

namespace delf {

namespace detail {
/// Below this the series are used; what they neglect first is 1e-17. Packs have a polynomial there.
inline constexpr double sinc_series_below = 0.25, sinc_near_zero_below = sinc_series_below * sinc_series_below;
inline double sinc_series(double s) {  // s = x²:  1 − s/3! + s²/5! − …
  return 1.0 + s * (-1. / 6 + s * (1. / 120 + s * (-1. / 5040 + s * (1. / 362880 + s * (-1. / 39916800)))));
}
inline double sinc_slope_series(double x, double s) {  // −x/3 + x³/30 − x⁵/840 + …
  return x *
         (-1. / 3 + s * (1. / 30 + s * (-1. / 840 + s * (1. / 45360 + s * (-1. / 3991680 + s * (1. / 518918400))))));
}

// Packs: difference quotients ask for sinc of small differences, so that polynomials alone serve, without any
// division; all minimax, found and rounded as the sine's. Of sinc itself that of |x| ≤ ¼ while all lanes are there, with
// the error 5.3e-17, half of what rounding to a number near 1 makes. The others reach to π/2, with errors 2.8e-19 (sinc),
// 1.9e-17 (slope) and 1.9e-17 (curvature). A pack that has a lane beyond takes the quotient too, out of line, for those
// lanes only.
template <class P>
inline P sinc_near_zero(P s) {
  return horner(s, 0x1.715b300d99672p-19, -0x1.a019e61b343a5p-13, 0x1.1111110ec9ecep-7, -0x1.5555555555195p-3, 1.0);
}
inline constexpr double sinc_polynomial_below = 0x1.921fb54442d18p+0;
inline Pack sinc_slope_part(Pack s) {  // (x cos x − sin x)/x³
  return horner(s, 0x1.861c78714c056p-45, -0x1.7869c1b763d91p-37, 0x1.08daa1cd3a322p-29, -0x1.0cfeb453da835p-22,
                0x1.71de3a506f514p-16, -0x1.381381380c769p-10, 0x1.1111111111098p-5, -0x1.5555555555555p-2);
}
inline Pack sinc_curvature_part(Pack s) {
  return horner(s, -0x1.1f20e113e389fp-49, 0x1.792fa32f3da0cp-41, -0x1.32041b6b8fd07p-33, 0x1.6c2d59b9fcc1ep-26,
                -0x1.2e9e8c70238f9p-19, 0x1.43a27309cc0d6p-13, -0x1.86186186160dfp-8, 0x1.9999999999954p-4,
                -0x1.5555555555555p-2);
}
template <class Function>
[[gnu::noinline]] Pack far_from_zero(Pack x, Pack near, Function f) {
  return {abs(x).v <= sinc_polynomial_below ? near.v : f(x).v};
}
/// Each lane as if it were alone: either polynomial or the quotient.
[[gnu::noinline, gnu::const]] inline Pack sinc_of_any(Pack x) {
  const Pack s = x * x;
  const Pack near{s.v <= sinc_near_zero_below ? sinc_near_zero(s).v : (sine_cubic_part(s) * s + 1.0).v};
  if (any_above(abs(x), sinc_polynomial_below))
    return far_from_zero(x, near, [](Pack y) { return sin(y) / y; });
  return near;
}
}  // namespace detail

/// sin(x)/x, with its value 1 and its derivative 0 at x = 0.
inline double sinc(double x) {
  return std::abs(x) < detail::sinc_series_below ? detail::sinc_series(x * x) : std::sin(x) / x;
}
inline Pack sinc(Pack x) {
  const Pack s = x * x;
  if (detail::any_above(s, detail::sinc_near_zero_below)) [[unlikely]]
    return detail::sinc_of_any(x);
  return detail::sinc_near_zero(s);
}

/// d sinc/dx = (cos x − sinc x)/x
inline double sinc_slope(double x) {
  return std::abs(x) < detail::sinc_series_below ? detail::sinc_slope_series(x, x * x)
                                                 : (std::cos(x) - std::sin(x) / x) / x;
}
inline Pack sinc_slope(Pack x) {
  const Pack near = x * detail::sinc_slope_part(x * x);
  if (detail::any_above(abs(x), detail::sinc_polynomial_below)) [[unlikely]]
    return detail::far_from_zero(x, near, [](Pack y) { return (cos(y) - sin(y) / y) / y; });
  return near;
}

/// d² sinc/dx² = −sinc x − 2 (d sinc/dx)/x
inline double sinc_curvature(double x) {
  const double s = x * x;
  if (std::abs(x) >= detail::sinc_series_below) return -sinc(x) - 2 * sinc_slope(x) / x;
  return -1. / 3 + s * (1. / 10 + s * (-1. / 168 + s * (1. / 6480 + s * (-1. / 443520 + s * (1. / 47174400)))));
}
inline Pack sinc_curvature(Pack x) {
  const Pack near = detail::sinc_curvature_part(x * x);
  if (detail::any_above(abs(x), detail::sinc_polynomial_below)) [[unlikely]]
    return detail::far_from_zero(x, near, [](Pack y) {
      const Pack quotient = sin(y) / y;
      return -quotient - 2.0 * ((cos(y) - quotient) / y) / y;
    });
  return near;
}
/// The operations that a Hessian by Dual of Dual needs.
template <class T, int n>
Dual<T, n> sinc_slope(const Dual<T, n>& u) {
  return chain(u, sinc_slope(u.value), sinc_curvature(u.value));
}

template <class T, int n>
Dual<T, n> sinc(const Dual<T, n>& u) {
  return chain(u, sinc(u.value), sinc_slope(u.value));
}

}  // namespace delf
