// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>

#include "jets/simd/pack.hpp"

namespace delf {

// Densities call sin, cos, … unqualified; inside namespace delf these must also find the scalar functions.
using std::abs;
using std::atan;
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

template <class Function>
inline Pack by_lane(Pack x, Function f) {
  for (int l = 0; l < lanes; ++l) x.v[l] = f(x.v[l]);
  return x;
}

/// f in the lanes beyond ±bound (or NaN); the others keep the bits of `near`, whatever their neighbours are. Out of
/// line: it is rarely wanted, and a library call inlined into a kernel makes that spill registers. Const, so that it
/// goes where its value is not wanted.
template <class Function>
[[gnu::noinline, gnu::const]] Pack with_far_lanes(Pack x, Pack near, double bound, Function f) {
  for (int l = 0; l < lanes; ++l)
    if (!(std::abs(x[l]) <= bound)) near.v[l] = f(x[l]);
  return near;
}

// Adding and subtracting 1.5·2⁵² rounds to the nearest integer, and the lowest bits of the sum are that integer.
inline constexpr double round_magic = 0x1.8p52;

inline Pack sign_of(Pack x) {
  return {reinterpret_cast<Pack::Vector>(reinterpret_cast<Pack::Bits>(x.v) & Pack::sign_bit)};
}
inline Pack sign_of_parity(Pack rounded_with_magic) {
  return {reinterpret_cast<Pack::Vector>(reinterpret_cast<Pack::Bits>(rounded_with_magic.v) << 63)};
}
/// Each lane negated where that of `sign` has its sign bit set.
inline Pack times_sign(Pack x, Pack sign) {
  return {reinterpret_cast<Pack::Vector>(reinterpret_cast<Pack::Bits>(x.v) ^ reinterpret_cast<Pack::Bits>(sign.v))};
}

/// The largest argument at which reduction by two parts of π is as good as exact; lanes beyond use the library's sine.
inline constexpr double largest_reduced = 3e6;

// π = π₁ + π₂ + 7e-27, π₁ of 32 bits. For |x| ≤ 3e6 the n below has at most 21 bits (a half included), so nπ₁ is exact,
// and so is x − nπ₁: a multiple of the last bit of x or of 2⁻³¹, and no larger than x or than 2. The error of nπ₂ is
// below 9.6e5·(2⁻³³·2⁻⁵³ + 7e-27) = 2e-20: of the whole reduction only the last subtraction rounds. None of this needs
// a fused multiply–add, or is spoiled by one.
inline constexpr double pi_1 = 0x1.921fb544p+1, pi_2 = 0x1.0b4611a626331p-33, over_pi = 0x1.45f306dc9c883p-2;

/// A pack as it is: types of several packs may overload this to keep their operations in order.
inline Pack side_by_side(Pack x) { return x; }
/// Σ_j c_j s^j, the highest coefficient first.
template <class P, class... Lower>
[[gnu::always_inline]] inline P horner(P s, double highest, double next, Lower... lower) {
  P p = highest * s + next;
  ((p = side_by_side(p) * s + lower), ...);
  return p;
}

/// p(s) = c₀ + s(E(y) + s O(y)), y = s², of degree 7, with the roots −q₁ and −q₀ of O divided out of both:
///
///     p(s) = c₀ + s(((c₇ y + c₆ s + b)(y + q₁) + r₁)(y + q₀) + r₀)
///
/// Eve's form (Numer. Math. 6, 17, 1964) of all but the last step of Horner's scheme: a product less, two sums more, and
/// the result waits for five steps in place of seven, which is what loops of sines take their time for.
template <class P>
[[gnu::always_inline]] inline P eve(P s, double c7, double c6, double b, double q1, double r1, double q0, double r0,
                                    double c0) {
  const P y = s * s;
  P p = side_by_side(c6 * s + b);
  const P y1 = y + q1, y0 = y + q0;
  p = side_by_side(c7 * y + p);
  p = side_by_side(p * y1 + r1);
  p = side_by_side(p * y0 + r0);
  return p * s + c0;
}

/// (sin r − r)/r³ as a polynomial in s = r²; it gives sinc as well: sin(r)/r = 1 + s·(this). Minimax on |r| ≤ π/2 for
/// the error of sin(r)/r, by Remez exchange in 60 digits, brought into Eve's form, and its coefficients rounded to doubles
/// that together keep the error. Degree 17 of the sine; error 4.6e-19 (degree 15: 1.2e-16).
template <class P>
inline P sine_cubic_part(P s) {
  return eve(s, 0x1.8850cd787a7fcp-49, -0x1.ae44a1b917e49p-41, 0x1.39d9eda06dc4ep-34, 0x1.a26f6d65d45e1p+13,
             -0x1.3762b99d9a13ap-22, 0x1.2eee01fe67467p+14, -0x1.2b781bd6e3607p-8, -0x1.5555555555555p-3);
}
/// (cos r − 1)/s for |r| ≤ π/2, s = r²: found, rounded and summed as the sine's; relative error 1.9e-17.
template <class P>
inline P cosine_square_part(P s) {
  return eve(s, 0x1.a122a5193e8c0p-45, -0x1.93639462df370p-37, 0x1.0be005726eac6p-30, 0x1.c17ee5d418a4dp+12,
             -0x1.1c06c7cfb6acfp-18, 0x1.0730643e526dfp+14, -0x1.4e2b58e1a52fdp-8, -0.5);
}

/// sin r, its sign turned where that of `sign` is set, which s need not wait for.
template <class P>
inline P sine_near_zero(P r, P s, P sign) {
  const P turned = times_sign(r, sign);
  return (turned * s) * sine_cubic_part(s) + turned;
}

/// c − q where the rounded number is odd, q where it is even.
inline Pack turned_about_where_odd(Pack c, Pack q, Pack rounded_with_magic) {
#if defined(DELF_ZMM)
  const __mmask8 odd = _mm512_test_epi64_mask(_mm512_castpd_si512(rounded_with_magic.v), _mm512_set1_epi64(1));
  return {_mm512_mask_sub_pd(q.v, odd, c.v, q.v)};
#elif defined(DELF_YMM)  // the lowest bit becomes the sign bit, which chooses
  return {_mm256_blendv_pd(q.v, (c - q).v,
                           reinterpret_cast<Pack::Vector>(reinterpret_cast<Pack::Bits>(rounded_with_magic.v) << 63))};
#else
  const Pack::Bits odd = -(reinterpret_cast<Pack::Bits>(rounded_with_magic.v) & 1);
  return {reinterpret_cast<Pack::Vector>((odd & reinterpret_cast<Pack::Bits>((c - q).v)) |
                                         (~odd & reinterpret_cast<Pack::Bits>(q.v)))};
#endif
}
/// n + round_magic, n the integer nearest to x/π.
template <class P>
inline P multiple_of_pi(P x) {
  return x * over_pi + round_magic;
}
/// r = x − nπ.
template <class P>
inline P rest_of_pi(P x, P shifted) {
  const P n = shifted - round_magic;
  return (x - n * pi_1) - n * pi_2;
}
/// cos x − 1 from r, s = r². With q = cos r − 1: q where n is even, −2 − q where it is odd.
template <class P>
inline P cosm1_near_multiple(P s, P shifted) {
  return turned_about_where_odd(P(-2.0), s * cosine_square_part(s), shifted);
}

template <class P>
inline P sine_in_reach(P x) {
  const P shifted = multiple_of_pi(x), r = rest_of_pi(x, shifted);
  return sine_near_zero(r, P(r * r), sign_of_parity(shifted));
}
template <class P>
inline P cosm1_in_reach(P x) {
  const P shifted = multiple_of_pi(x), r = rest_of_pi(x, shifted);
  return cosm1_near_multiple(P(r * r), shifted);
}
template <class P>
inline P cosine_in_reach(P x) {
  const P magnitude = abs(x);
  const P shifted = (magnitude * over_pi - 0.5) + round_magic;
  const P n = (shifted - round_magic) + 0.5;
  const P r = (n * pi_1 - magnitude) + n * pi_2;
  return sine_near_zero(r, P(r * r), sign_of_parity(shifted));
}
/// Returns `near`, with f(x) in the lanes where |x| exceeds the bound.
template <class Function>
[[gnu::always_inline]] inline Pack asked(Pack x, Pack near, double bound, Function f) {
  if (any_above(abs(x), bound)) [[unlikely]]
    return with_far_lanes(x, near, bound, f);
  return near;
}

}  // namespace detail

/// sin x = (−1)ⁿ sin(x − nπ), n the integer nearest to x/π. Error below 2.5e-16 absolute for |x| ≤ 3e6 (measured:
/// 2.1e-16 with fused multiply–adds, 2.3e-16 without). sin(−0) is +0.
inline Pack sin(Pack x) {
  return detail::asked(x, detail::sine_in_reach(x), detail::largest_reduced, [](double y) { return std::sin(y); });
}
/// cos x = (−1)ⁿ sin((n + ½)π − |x|), n the integer nearest to |x|/π − ½. Error as of the sine.
inline Pack cos(Pack x) {
  return detail::asked(x, detail::cosine_in_reach(x), detail::largest_reduced, [](double y) { return std::cos(y); });
}

/// cos x − 1 = −2 sin²(x/2): where cos x is all but 1, its difference from 1 is rounding.
inline double cosm1(double x) {
  const double s = std::sin(0.5 * x);
  return -2 * (s * s);
}
/// Asks whether lanes are too far of x as sin x does: a density's value and derivative ask once, and where the value is
/// not wanted nothing of it is left.
inline Pack cosm1(Pack x) {
  return detail::asked(x, detail::cosm1_in_reach(x), detail::largest_reduced, [](double y) { return cosm1(y); });
}

/// cos x where sin x is wanted too, whose derivative it is: from the same multiple of π, which compilers then find once.
/// Error below 3e-16 absolute.
inline Pack cosine_beside_sine(Pack x) { return cosm1(x) + 1.0; }
/// The cosine beside a known sine; numbers other than packs have no cheaper way.
inline auto cosine_beside_sine(const auto& x) { return cos(x); }

namespace detail {

// log 2 = a part of 42 bits, whose products with |n| < 2¹¹ are exact, and a rest (and 2e-31).
inline constexpr double log2_1 = 0x1.62e42fefa38p-1, log2_2 = 0x1.ef35793c7673p-45, over_log2 = 0x1.71547652b82fep+0;

/// x = n log 2 + r + low, n the integer nearest to x/log 2, low the rounding of r; and the parts of eʳ⁺ˡᵒʷ:
///     cosh r = 1 + even
///     sinh r + low = r + cubic
struct ExpParts {
  Pack shifted, n, r, even, cubic;  ///< shifted: n + round_magic
};

/// Polynomials of degree 10 and 11, minimax on |r| ≤ ½ log 2 and rounded as the sine's above; the error of the even
/// part is 3.6e-18, that of the odd one 2.7e-19 of r. Always inline: a product that it returns is rounded then nowhere, or
/// everywhere, where what it is added to may be fused with it.
[[gnu::always_inline]] inline ExpParts exp_parts(Pack x) {
  const Pack shifted = x * over_log2 + round_magic;
  const Pack n = shifted - round_magic;
  const Pack coarse = x - n * log2_1, r = coarse - n * log2_2, low = (coarse - r) - n * log2_2;
  const Pack s = r * r;
  Pack a = 0x1.28b1bdb4ae1ddp-22, b = 0x1.af5ff2bddcfd6p-26;
  a = a * s + 0x1.a01994ffc385ep-16;
  b = b * s + 0x1.71ddf7b00573fp-19;
  a = a * s + 0x1.6c16c1863e1acp-10;
  b = b * s + 0x1.a01a01b0204bfp-13;
  a = a * s + 0x1.555555554fd67p-5;
  b = b * s + 0x1.111111110f62ap-7;
  a = a * s + 0x1.000000000000cp-1;
  b = b * s + 0x1.5555555555559p-3;
  return {shifted, n, r, a * s, (r * s) * b + low};
}

/// 2ⁿ for an integer −1022 … 1023 to which round_magic was added.
inline Pack power_of_2(Pack shifted) {
  return {reinterpret_cast<Pack::Vector>((reinterpret_cast<Pack::Bits>(shifted.v) + 1023) << 52)};
}

/// y 2ⁿ for the integers n, −1076 … 1024.
inline Pack times_power_of_2(Pack y, Pack n) {
#if defined(DELF_ZMM)
  return {_mm512_maskz_scalef_pd(0xff, y.v, n.v)};
#else  // 2ⁿ itself may not be a number, its two halves are
  const Pack half = n * 0.5 + round_magic;
  const Pack rest = (n - (half - round_magic)) + round_magic;
  return (y * power_of_2(half)) * power_of_2(rest);
#endif
}

struct Hyperbolic {
  Pack sinh, cosh;
};
inline constexpr double largest_hyperbolic = 700;

/// Addition theorems for |x| = n log 2 + r, with C, S the hyperbolic functions of n log 2:
///     cosh |x| = C + (C (cosh r − 1) + S sinh r)
///     sinh |x| = S + (S (cosh r − 1) + C sinh r)
/// Where n = 0 the latter is sinh r alone: small x keep all their digits.
inline Hyperbolic hyperbolic(Pack magnitude) {
  const ExpParts e = exp_parts(magnitude);
  const Pack grown = 0.5 * power_of_2(e.shifted), decayed = 0.5 * power_of_2(round_magic - e.n);
  const Pack C = grown + decayed, S = grown - decayed, odd = e.cubic + e.r;
  return {S + (S * e.even + C * odd), C + (C * e.even + S * odd)};
}
inline Pack sinh_in_reach(Pack x) { return times_sign(hyperbolic(abs(x)).sinh, sign_of(x)); }

}  // namespace detail

/// eˣ = 2ⁿ eʳ. Relative error below 2e-16; 0 and infinity where std::exp has them.
inline Pack exp(Pack x) {
  // Beyond these bounds eˣ is 0 or infinity anyway. A NaN stays.
  constexpr double lowest = -746, highest = 710;
  const detail::ExpParts e = detail::exp_parts(detail::smaller(highest, detail::larger(lowest, x)));
  return detail::times_power_of_2(((e.even + e.cubic) + e.r) + 1.0, e.n);
}

/// Relative error below 4e-16, as of the next two (measured: 3.1e-16 and 3.7e-16 for tanh).
inline Pack sinh(Pack x) {
  return detail::asked(x, detail::sinh_in_reach(x), detail::largest_hyperbolic, [](double y) { return std::sinh(y); });
}
inline Pack cosh(Pack x) {
  return detail::asked(x, detail::hyperbolic(abs(x)).cosh, detail::largest_hyperbolic,
                       [](double y) { return std::cosh(y); });
}
/// tanh |x| = E/(E + 2), E = exp(2|x|) − 1 = (2ⁿ − 1) + 2ⁿ(eʳ − 1), which is eʳ − 1 alone for small x.
inline Pack tanh(Pack x) {
  constexpr double saturated = 20;  // 1 − tanh 20 is 8e-18
  const detail::ExpParts e = detail::exp_parts(2.0 * detail::smaller(saturated, abs(x)));
  const Pack grown = detail::power_of_2(e.shifted);
  const Pack E = (grown - 1.0) + grown * ((e.even + e.cubic) + e.r);
  return detail::times_sign(E / (E + 2.0), detail::sign_of(x));
}

inline Pack sqrt(Pack x) {
#if defined(DELF_ZMM)
  return {_mm512_maskz_sqrt_pd(0xff, x.v)};
#elif defined(DELF_YMM)
  return {_mm256_sqrt_pd(x.v)};
#elif defined(DELF_XMM)
  return detail::by_registers([](__m128d y) { return _mm_sqrt_pd(y); }, x);
#else
  return detail::by_lane(x, [](double y) { return std::sqrt(y); });
#endif
}

// The rest is called lane by lane: correct for any density, not tuned.
inline Pack log(Pack x) {
  return detail::by_lane(x, [](double y) { return std::log(y); });
}
inline Pack tan(Pack x) {
  return detail::by_lane(x, [](double y) { return std::tan(y); });
}
inline Pack atan(Pack x) {
  return detail::by_lane(x, [](double y) { return std::atan(y); });
}
inline Pack pow(Pack x, double p) {
  return detail::by_lane(x, [p](double y) { return std::pow(y, p); });
}

}  // namespace delf
