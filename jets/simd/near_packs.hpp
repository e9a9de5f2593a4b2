// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <type_traits>
#include <utility>

#include "jets/simd/near_pack.hpp"

namespace delf {

/// NearPacks that are worked on side by side, with the same bits. In a sine everything waits for what has just been worked
/// out, and processors see no further ahead than two or three sines that follow each other: where the instructions of four
/// take turns, an explicit step takes an eighth less.
struct NearPacks {
  static constexpr int count = lanes == 8 ? 4 : 2;  ///< as registers allow: 32 of them, or 16
  NearPack of[count];

  NearPacks() = default;
  constexpr NearPacks(Pack same) {
    for (NearPack& x : of) x = same;
  }
  constexpr NearPacks(double x) : NearPacks(Pack(x)) {}
  /// f(i) for number i.
  template <class Function>
  [[gnu::always_inline]] static NearPacks each(const Function& f) {
    return [&]<int... i>(std::integer_sequence<int, i...>) __attribute__((always_inline)) {
      NearPacks x;
      ((x.of[i] = f(i)), ...);
      return x;
    }
    (std::make_integer_sequence<int, count>{});
  }

  friend NearPacks operator+(const NearPacks& a, const NearPacks& b) {
    return each([&](int i) __attribute__((always_inline)) { return a.of[i] + b.of[i]; });
  }
  friend NearPacks operator-(const NearPacks& a, const NearPacks& b) {
    return each([&](int i) __attribute__((always_inline)) { return a.of[i] - b.of[i]; });
  }
  friend NearPacks operator*(const NearPacks& a, const NearPacks& b) {
    return each([&](int i) __attribute__((always_inline)) { return a.of[i] * b.of[i]; });
  }
  friend NearPacks operator/(const NearPacks& a, const NearPacks& b) {
    return each([&](int i) __attribute__((always_inline)) { return a.of[i] / b.of[i]; });
  }
  friend NearPacks operator-(const NearPacks& a) {
    return each([&](int i) __attribute__((always_inline)) { return -a.of[i]; });
  }

  friend NearPacks sin(const NearPacks& x) { return detail::sine_in_reach(x); }
  friend NearPacks cos(const NearPacks& x) { return detail::cosine_in_reach(x); }
  friend NearPacks cosm1(const NearPacks& x) { return detail::cosm1_in_reach(x); }
  friend NearPacks sinc(const NearPacks& x) {
    const NearPacks s = x * x;
    bool any = false;
    for (const NearPack& one : s.of) any |= detail::any_above(one, detail::sinc_near_zero_below);
    if (any) [[unlikely]]
      return each([&](int i) { return detail::sinc_of_any(x.of[i]); });
    return detail::sinc_near_zero(s);
  }

  // What else there is goes one after the other.
  friend NearPacks sinh(const NearPacks& x) { return by_one(x, [](NearPack u) { return sinh(u); }); }
  friend NearPacks cosh(const NearPacks& x) { return by_one(x, [](NearPack u) { return cosh(u); }); }
  friend NearPacks tan(const NearPacks& x) { return by_one(x, [](NearPack u) { return tan(u); }); }
  friend NearPacks exp(const NearPacks& x) { return by_one(x, [](NearPack u) { return exp(u); }); }
  friend NearPacks log(const NearPacks& x) { return by_one(x, [](NearPack u) { return log(u); }); }
  friend NearPacks sqrt(const NearPacks& x) { return by_one(x, [](NearPack u) { return sqrt(u); }); }
  friend NearPacks tanh(const NearPacks& x) { return by_one(x, [](NearPack u) { return tanh(u); }); }
  friend NearPacks pow(const NearPacks& x, double p) { return by_one(x, [p](NearPack u) { return pow(u, p); }); }
  friend NearPacks sinc_slope(const NearPacks& x) { return by_one(x, [](NearPack u) { return sinc_slope(u); }); }

  // What functions in reach are made of.
  friend NearPacks abs(const NearPacks& x) { return by_one(x, [](NearPack u) { return abs(static_cast<Pack>(u)); }); }
  friend NearPacks sign_of_parity(const NearPacks& rounded) {
    return by_one(rounded, [](NearPack u) { return detail::sign_of_parity(u); });
  }
  friend NearPacks times_sign(const NearPacks& x, const NearPacks& sign) {
    return each([&](int i) __attribute__((always_inline)) { return detail::times_sign(x.of[i], sign.of[i]); });
  }
  friend NearPacks turned_about_where_odd(const NearPacks& c, const NearPacks& q, const NearPacks& rounded) {
    return each([&](int i) __attribute__((always_inline)) {
      return detail::turned_about_where_odd(c.of[i], q.of[i], rounded.of[i]);
    });
  }
  /// Compilers would put all instructions of one pack after those of another. What works x out goes before this, and
  /// what needs x after it.
  friend NearPacks side_by_side(NearPacks x) {
#if defined(__SSE2__)
    if constexpr (count == 4) asm("" : "+v"(x.of[0].v), "+v"(x.of[1].v), "+v"(x.of[2].v), "+v"(x.of[3].v));
    else asm("" : "+v"(x.of[0].v), "+v"(x.of[1].v));
#endif
    return x;
  }

 private:
  template <class Function>
  [[gnu::always_inline]] static NearPacks by_one(const NearPacks& x, const Function& f) {
    return each([&](int i) __attribute__((always_inline)) { return f(x.of[i]); });
  }
};

/// What f(at) makes of the packs of a Value: of NearPacks one after the other.
template <class Value, class Function>
[[gnu::always_inline]] inline Value of_packs(std::ptrdiff_t at, const Function& f) {
  if constexpr (std::is_same_v<Value, NearPacks>)
    return NearPacks::each([&](int i) __attribute__((always_inline)) { return f(at + i * lanes); });
  else return f(at);
}
/// f(at, x) for each pack of x.
template <class Function>
[[gnu::always_inline]] inline void for_each_pack(const NearPacks& x, std::ptrdiff_t at, const Function& f) {
  [&]<int... i>(std::integer_sequence<int, i...>) __attribute__((always_inline)) { (f(at + i * lanes, x.of[i]), ...); }
  (std::make_integer_sequence<int, NearPacks::count>{});
}

}  // namespace delf
