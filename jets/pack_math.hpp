// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>

#include "jets/pack.hpp"

namespace delf {

// Densities call sin, cos, … unqualified; inside namespace delf these must also find the scalar functions.
using std::abs;
using std::cos;
using std::cosh;
using std::exp;
using std::log;
using std::pow;
using std::sin;
using std::sinh;
using std::sqrt;
using std::tan;
using std::tanh;

namespace detail {

/// Where Cody–Waite reduction by three parts of π is still exact; beyond it the library's sine is used lane by lane.
inline constexpr double largest_reduced = 1e6;

template <class Function>
inline Pack by_lane(Pack x, Function f) {
  for (int l = 0; l < lanes; ++l) x.v[l] = f(x.v[l]);
  return x;
}

inline bool any_above(Pack x, double bound) {
  const auto above = (x.v > bound) | (x.v < -bound) | (x.v != x.v);
  long long any = 0;
  for (int l = 0; l < lanes; ++l) any |= above[l];
  return any != 0;
}

/// x − nπ for the integers n (given as doubles), π in two parts of 32 bits and a rest, so that the first two
/// products are exact for |n| < 2²¹, with or without fused multiply–adds.
inline Pack minus_multiple_of_pi(Pack x, Pack n) {
  constexpr double pi_1 = 0x1.921fb544p+1, pi_2 = 0x1.0b4611a6p-33, pi_3 = 0x1.3198a2e037073p-68;
  return ((x - n * pi_1) - n * pi_2) - n * pi_3;
}

/// sin r for |r| ≤ π/2: the Taylor polynomial of degree 21, whose remainder (π/2)²³/23! is 1e-18.
inline Pack sine_near_zero(Pack r) {
  const Pack s = r * r;
  Pack p = 1.0 / 51090942171709440000.0;
  p = p * s - 1.0 / 121645100408832000.0;
  p = p * s + 1.0 / 355687428096000.0;
  p = p * s - 1.0 / 1307674368000.0;
  p = p * s + 1.0 / 6227020800.0;
  p = p * s - 1.0 / 39916800.0;
  p = p * s + 1.0 / 362880.0;
  p = p * s - 1.0 / 5040.0;
  p = p * s + 1.0 / 120.0;
  p = p * s - 1.0 / 6.0;
  return r + r * (s * p);
}

// Adding and subtracting 1.5·2⁵² rounds to the nearest integer; the lowest bit of the sum is that integer's parity.
inline constexpr double round_magic = 0x1.8p52;
using PackBits = long long __attribute__((vector_size(sizeof(double) * lanes)));
inline Pack with_sign_of_parity(Pack value, Pack rounded_with_magic) {
  PackBits parity, bits;
  std::memcpy(&parity, &rounded_with_magic.v, sizeof parity);
  std::memcpy(&bits, &value.v, sizeof bits);
  bits ^= parity << 63;
  std::memcpy(&value.v, &bits, sizeof bits);
  return value;
}

}  // namespace detail

/// sin x = (−1)ⁿ sin(x − nπ), n the integer nearest to x/π. Error below 2.5e-16 absolute for |x| ≤ 1e6.
inline Pack sin(Pack x) {
  if (detail::any_above(x, detail::largest_reduced)) [[unlikely]]
    return detail::by_lane(x, [](double y) { return std::sin(y); });
  const Pack shifted = x * 0.318309886183790671538 + detail::round_magic;
  const Pack n = shifted - detail::round_magic;
  return detail::with_sign_of_parity(detail::sine_near_zero(detail::minus_multiple_of_pi(x, n)), shifted);
}

/// cos x = −(−1)ⁿ sin(x − (n + ½)π), n the integer nearest to x/π − ½.
inline Pack cos(Pack x) {
  if (detail::any_above(x, detail::largest_reduced)) [[unlikely]]
    return detail::by_lane(x, [](double y) { return std::cos(y); });
  const Pack shifted = (x * 0.318309886183790671538 - 0.5) + detail::round_magic;
  const Pack n = shifted - detail::round_magic;
  return -detail::with_sign_of_parity(detail::sine_near_zero(detail::minus_multiple_of_pi(x, n + 0.5)), shifted);
}

// The rest is called lane by lane: correct for any density, not tuned.
inline Pack exp(Pack x) { return detail::by_lane(x, [](double y) { return std::exp(y); }); }
inline Pack log(Pack x) { return detail::by_lane(x, [](double y) { return std::log(y); }); }
inline Pack sqrt(Pack x) { return detail::by_lane(x, [](double y) { return std::sqrt(y); }); }
inline Pack tan(Pack x) { return detail::by_lane(x, [](double y) { return std::tan(y); }); }
inline Pack sinh(Pack x) { return detail::by_lane(x, [](double y) { return std::sinh(y); }); }
inline Pack cosh(Pack x) { return detail::by_lane(x, [](double y) { return std::cosh(y); }); }
inline Pack tanh(Pack x) { return detail::by_lane(x, [](double y) { return std::tanh(y); }); }
inline Pack pow(Pack x, double p) { return detail::by_lane(x, [p](double y) { return std::pow(y, p); }); }

}  // namespace delf
