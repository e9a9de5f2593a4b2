// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <utility>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace delf {

// A pack is one register of the widest kind; or four numbers on every x86-64 processor (DELF_FOUR_LANES), as sums and
// solutions are rounded otherwise for another number of lanes. The macro names the registers that packs are worked on in.
#if defined(__AVX512F__) && !defined(DELF_FOUR_LANES)
#define DELF_ZMM
inline constexpr int lanes = 8;
#elif defined(__AVX__)
#define DELF_YMM
inline constexpr int lanes = 4;
#elif defined(__SSE2__)
#define DELF_XMM
#if defined(DELF_FOUR_LANES)
inline constexpr int lanes = 4;
#else
inline constexpr int lanes = 2;
#endif
#else
inline constexpr int lanes = 2;
#endif

/// `lanes` doubles that are worked on at once: a thin wrapper over the compiler's vector extension. Densities see it
/// (inside a Dual) as just another number. Mathematical functions are in jets/simd/pack_math.hpp.
struct Pack {
  using Vector = double __attribute__((vector_size(sizeof(double) * lanes)));
  using Bits = long long __attribute__((vector_size(sizeof(double) * lanes)));
  static constexpr long long sign_bit = static_cast<long long>(1ull << 63);
  Vector v;

  Pack() = default;
  constexpr Pack(Vector vector) : v(vector) {}
  constexpr Pack(double x) : v(x - Vector{}) {}  // not Vector{} + x: −0 + 0 is +0

  /// From and to memory aligned to a whole pack.
  static Pack load(const double* p) { return Pack{*reinterpret_cast<const Aliased*>(p)}; }
  void store(double* p) const { *reinterpret_cast<Aliased*>(p) = v; }

  double operator[](int lane) const { return v[lane]; }

  friend Pack operator+(Pack a, Pack b) { return {a.v + b.v}; }
  friend Pack operator-(Pack a, Pack b) { return {a.v - b.v}; }
  friend Pack operator*(Pack a, Pack b) { return {a.v * b.v}; }
  friend Pack operator/(Pack a, Pack b) { return {a.v / b.v}; }
  friend Pack operator-(Pack a) { return {-a.v}; }
  Pack& operator+=(Pack b) {
    v += b.v;
    return *this;
  }
  Pack& operator-=(Pack b) {
    v -= b.v;
    return *this;
  }
  Pack& operator*=(Pack b) {
    v *= b.v;
    return *this;
  }

 private:
  using Aliased = double __attribute__((vector_size(sizeof(double) * lanes), may_alias));
};

inline Pack abs(Pack a) {
  return {reinterpret_cast<Pack::Vector>(reinterpret_cast<Pack::Bits>(a.v) & ~Pack::sign_bit)};
}

namespace detail {
#if defined(DELF_XMM)
inline __m128d register_of(const Pack& a, int first) {
  __m128d part;
  std::memcpy(&part, reinterpret_cast<const char*>(&a) + sizeof(double) * static_cast<unsigned>(first), sizeof part);
  return part;
}
/// f of the registers of packs, one after the other.
template <class Function, class... Packs>
[[gnu::always_inline]] inline Pack by_registers(Function f, const Packs&... packs) {
  Pack result;
  for (int first = 0; first < lanes; first += 2) {
    const __m128d part = f(register_of(packs, first)...);
    std::memcpy(reinterpret_cast<char*>(&result) + sizeof(double) * static_cast<unsigned>(first), &part, sizeof part);
  }
  return result;
}
#endif
// The larger or smaller of two, and b if either is NaN: what one instruction gives. (Compilers find it in a > b ? a : b
// for some instruction sets only. Masks of all lanes spare gcc a warning about its own headers.)
inline Pack larger(Pack a, Pack b) {
#if defined(DELF_ZMM)
  return {_mm512_maskz_max_pd(0xff, a.v, b.v)};
#elif defined(DELF_YMM)
  return {_mm256_max_pd(a.v, b.v)};
#elif defined(DELF_XMM)
  return by_registers([](__m128d x, __m128d y) { return _mm_max_pd(x, y); }, a, b);
#else
  return {a.v > b.v ? a.v : b.v};
#endif
}
inline Pack smaller(Pack a, Pack b) {
#if defined(DELF_ZMM)
  return {_mm512_maskz_min_pd(0xff, a.v, b.v)};
#elif defined(DELF_YMM)
  return {_mm256_min_pd(a.v, b.v)};
#elif defined(DELF_XMM)
  return by_registers([](__m128d x, __m128d y) { return _mm_min_pd(x, y); }, a, b);
#else
  return {a.v < b.v ? a.v : b.v};
#endif
}
/// Is any lane above the bound, or NaN?
inline bool any_above(Pack x, double bound) {
#if defined(DELF_ZMM)
  return _mm512_cmp_pd_mask(x.v, Pack(bound).v, _CMP_NLE_UQ) != 0;
#elif defined(DELF_YMM)
  return _mm256_movemask_pd(_mm256_cmp_pd(x.v, Pack(bound).v, _CMP_NLE_UQ)) != 0;
#elif defined(DELF_XMM)
  __m128d above = _mm_setzero_pd();
  for (int first = 0; first < lanes; first += 2)
    above = _mm_or_pd(above, _mm_cmpnle_pd(register_of(x, first), _mm_set1_pd(bound)));
  return _mm_movemask_pd(above) != 0;
#else
  bool any = false;
  for (int l = 0; l < lanes; ++l) any |= !(x[l] <= bound);
  return any;
#endif
}
}  // namespace detail

/// The larger of two; a NaN in either stays a NaN, so that a maximum over a row shows it.
inline Pack max_or_nan(Pack a, Pack b) {
#if defined(DELF_ZMM)
  return {_mm512_mask_max_pd(a.v, _mm512_cmp_pd_mask(a.v, a.v, _CMP_ORD_Q), a.v, b.v)};
#elif defined(DELF_XMM)  // all bits set is a NaN
  return detail::by_registers([](__m128d x, __m128d y) { return _mm_or_pd(_mm_max_pd(x, y), _mm_cmpunord_pd(x, x)); },
                              a, b);
#else
  return {reinterpret_cast<Pack::Vector>(reinterpret_cast<Pack::Bits>(detail::larger(a, b).v) | (a.v != a.v))};
#endif
}
inline double larger_or_nan(double a, double b) { return a > b || a != a ? a : b; }
/// The larger of two that are not negative; a NaN in either stays a NaN. As bits, magnitudes are in the order of integers,
/// and NaNs above all of them: that takes turns with what is added and multiplied, which maxima of numbers would wait for.
inline Pack larger_size(Pack a, Pack b) {
#if defined(DELF_ZMM)
  return {_mm512_castsi512_pd(_mm512_max_epu64(_mm512_castpd_si512(a.v), _mm512_castpd_si512(b.v)))};
#else
  return max_or_nan(b, a);
#endif
}
/// The larger of |a| and |b|, where a is not negative; a NaN in either stays a NaN.
inline Pack largest_magnitude(Pack a, Pack b) { return larger_size(a, abs(b)); }
namespace detail {
template <int by, int... l>
inline Pack rotated(Pack a, std::integer_sequence<int, l...>) {
  return {__builtin_shufflevector(a.v, a.v, ((l + by) % lanes)...)};
}
}  // namespace detail
/// Lane l of what lane l + 1, or l − 1, was; round the end.
inline Pack from_lane_above(Pack a) { return detail::rotated<1>(a, std::make_integer_sequence<int, lanes>()); }
inline Pack from_lane_below(Pack a) { return detail::rotated<lanes - 1>(a, std::make_integer_sequence<int, lanes>()); }
/// Of all lanes, by halves: what waits for it waits for log₂ lanes additions.
inline double sum(Pack a) {
  constexpr auto all = std::make_integer_sequence<int, lanes>();
  if constexpr (lanes > 4) a += detail::rotated<4>(a, all);
  if constexpr (lanes > 2) a += detail::rotated<2>(a, all);
  return (a + detail::rotated<1>(a, all))[0];
}
inline double max_or_nan(Pack a) {
  constexpr auto all = std::make_integer_sequence<int, lanes>();
  if (detail::any_above(a, std::numeric_limits<double>::infinity())) [[unlikely]]
    return sum(a);
  if constexpr (lanes > 4) a = detail::larger(a, detail::rotated<4>(a, all));
  if constexpr (lanes > 2) a = detail::larger(a, detail::rotated<2>(a, all));
  return detail::larger(a, detail::rotated<1>(a, all))[0];
}

}  // namespace delf
