// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "jets/density.hpp"
#include "schemes/families/row_kernel.hpp"
#include "schemes/families/value_jet.hpp"

namespace delf {

/// The offsets −reach … −1, 1 … reach.
template <int reach>
inline constexpr auto neighbours_within = [] {
  std::array<int, static_cast<std::size_t>(2 * reach)> offsets{};
  for (int s = 0; s < reach; ++s)
    offsets[static_cast<std::size_t>(s)] = s - reach, offsets[static_cast<std::size_t>(reach + s)] = s + 1;
  return offsets;
}();

/// An explicit step of the packs of a row, in one loop:
///
///     w = Σ_s linear(s) (y(i + s) − y(i)) + nonlinear ∂ℓ/∂φ(y(i)),    v += w,    y += stride v
///
/// over the neighbours s within `reach`. What they were is carried along in registers, so that the new row may be
/// written over the old one. Returns Σy² of the new values: infinite or NaN where squares overflow.
///
/// `even`: stride is 1, and so far as one neighbour on either side is concerned linear(−1) = linear(1): a tenth less.
/// `kept`: the slopes ∂ℓ/∂φ are. `Value`: what they are evaluated on.
template <int reach, bool even, bool kept, class Value, Density D>
[[gnu::__flatten__, gnu::__noclone__]] double explicit_loop(const D& given_density, const ExplicitRows& given,
                                                            const PackRange& given_packs) {
  const PackRange packs = given_packs;
  constexpr int d = components_of<D>(), count = 2 * reach;
  // Copies of this function alone: what is stored through others cannot change them, so that they stay in registers.
  const D density = given_density;
  const double stride = given.stride;
  const double* const positions = given.now.positions;
  const Pack t(given.now.t);
  const std::ptrdiff_t origin = given.now.layout->at(0);
  std::array<const double*, d> now, v_before;
  std::array<double*, d> v_new, y_new, slopes;
  std::array<double, static_cast<std::size_t>(d * count)> linear;
  std::array<double, d> nonlinear;
  for (int a = 0; a < d; ++a) {
    now[a] = given.now.values[a], v_before[a] = given.v_before[a];
    v_new[a] = given.v[a], y_new[a] = given.y[a];
    nonlinear[a] = given.nonlinear[a];
    if constexpr (kept) slopes[a] = given.slopes[a];
    for (int s = 0; s < count; ++s) linear[a * count + s] = given.linear[a * count + s];
  }
  // Where the old value of a pack at or after the first one is, be it beyond the last.
  const auto old_value = [&](int a, int v) {
    return v < packs.last ? given.now.values[a] + given.now.layout->at(v)
                          : given.after[a] + static_cast<std::ptrdiff_t>(v - packs.last) * lanes;
  };
  std::array<std::array<Pack, static_cast<std::size_t>(2 * reach + 1)>, d> y;
  for (int a = 0; a < d; ++a)
    for (int s = 0; s < 2 * reach; ++s)
      y[a][s + 1] = Pack::load(s < reach ? given.before[a] + s * lanes : old_value(a, packs.first + s - reach));
  // y(i) − y(i − 1), where neighbours reach no further: the pack before has worked it out as y(i + 1) − y(i).
  std::array<Pack, d> last;
  for (int a = 0; a < d; ++a) last[a] = y[a][2 * reach] - y[a][2 * reach - 1];
  Pack squares(0.0);
  // Of packs that are not written over yet.
  const auto slopes_at = [&]<class Number>(std::ptrdiff_t from) __attribute__((always_inline)) {
    const auto value = [&](int a) __attribute__((always_inline)) {
      return of_packs<Number>(from, [&](std::ptrdiff_t to) __attribute__((always_inline)) {
        return Pack::load(now[a] + to);
      });
    };
    return density(value_jet<D, Number>(value, t, positions + from)).d;
  };
  const auto take = [&](const auto& incoming) __attribute__((always_inline)) {
    for (int a = 0; a < d; ++a) {
      for (int s = 0; s < 2 * reach; ++s) y[a][s] = y[a][s + 1];
      y[a][2 * reach] = Pack::load(incoming(a));
    }
  };
  const auto advance = [&](std::ptrdiff_t at, const std::array<Value, d>& here_slope) __attribute__((always_inline)) {
    for (int a = 0; a < d; ++a) {
      const Pack here = y[a][reach];
      if constexpr (kept) here_slope[a].store(slopes[a] + at);
      Pack w = nonlinear[a] * here_slope[a];
      if constexpr (reach == 1) {
        const Pack next = y[a][2] - here;
        if constexpr (even) {
          w += linear[a * count] * (next - last[a]);
        } else {
          w -= linear[a * count] * last[a];
          w += linear[a * count + 1] * next;
        }
        last[a] = next;
      } else {
        for (int s = 0; s < count; ++s)
          w += linear[a * count + s] * (y[a][reach + neighbours_within<reach>[static_cast<std::size_t>(s)]] - here);
      }
      const Pack v_next = Pack::load(v_before[a] + at) + w, y_next = here + (even ? v_next : stride * v_next);
      squares += y_next * y_next;
      v_next.store(v_new[a] + at);
      y_next.store(y_new[a] + at);
    }
  };
  int v = packs.first;
  if (v >= packs.last) return 0;
  std::ptrdiff_t at = origin + static_cast<std::ptrdiff_t>(v) * lanes;
  const auto incoming = [&](int a) { return old_value(a, v + reach); };
  take(incoming);
  const auto step = [&](const std::array<Value, d>& slope, const auto& source) __attribute__((always_inline)) {
    advance(at, slope);
    ++v, at += lanes;
    take(source);
  };
  // Slopes are evaluated ahead, and side by side: what waits for them would keep the next ones waiting.
  if constexpr (std::is_same_v<Value, NearPack>) {
    const auto inside = [&](int a) __attribute__((always_inline)) { return now[a] + at + reach * lanes; };
    const auto step_all = [&](const std::array<NearPacks, d>& slopes_of_all) __attribute__((always_inline)) {
      const auto step_one = [&](int i) __attribute__((always_inline)) {
        std::array<Value, d> slope;
        for (int a = 0; a < d; ++a) slope[a] = slopes_of_all[a].of[i];
        step(slope, inside);
      };
      [&]<int... i>(std::integer_sequence<int, i...>) __attribute__((always_inline)) { (step_one(i), ...); }
      (std::make_integer_sequence<int, NearPacks::count>{});
    };
    // All that is evaluated and comes in lies inside the row.
    const auto go_on = [&] __attribute__((always_inline)) { return packs.last - v > 2 * NearPacks::count + reach; };
    if (go_on()) {
      std::array<NearPacks, d> here = slopes_at.template operator()<NearPacks>(at);
      while (go_on()) {
        const std::array<NearPacks, d> next =
            slopes_at.template operator()<NearPacks>(at + NearPacks::count * lanes);
        step_all(here);
        here = next;
      }
      step_all(here);
    }
  }
  const std::ptrdiff_t last_at = origin + static_cast<std::ptrdiff_t>(packs.last - 1) * lanes;
  const auto slope = [&](std::ptrdiff_t from) __attribute__((always_inline)) {
    return slopes_at.template operator()<Value>(std::min(from, last_at));
  };
  std::array<Value, d> here = slope(at), next = slope(at + lanes);
  while (v < packs.last - 1) {
    const std::array<Value, d> third = slope(at + 2 * lanes);
    step(here, incoming);
    here = next, next = third;
  }
  advance(at, here);
  return sum(squares);
}

/// The slopes ∂ℓ/∂φ(y(i)) of such a step alone.
template <Density D>
[[gnu::__flatten__, gnu::__noclone__]] void slope_loop(const D& given_density, const SlabRows& now,
                                                       double* const* slopes, const PackRange& packs) {
  constexpr int d = components_of<D>();
  const D density = given_density;
  const Pack t(now.t);
  for (int v = packs.first; v < packs.last; ++v) {
    const std::ptrdiff_t at = now.layout->at(v);
    const auto l =
        density(value_jet<D>([&](int a) { return Pack::load(now.values[a] + at); }, t, now.positions + at));
    for (int a = 0; a < d; ++a) l.derivative(a).store(slopes[a] + at);
  }
}

/// The loop that the coefficients and the values allow. Few fields are too large to be near: for them slopes are kept by
/// a loop of their own.
template <int reach, Density D>
double explicit_loop_for(const D& density, const ExplicitRows& rows, const PackRange& packs) {
  bool even = rows.stride == 1;
  for (int a = 0; a < components_of<D>() && reach == 1; ++a)
    even = even && rows.linear[2 * a] == rows.linear[2 * a + 1];
  if (!rows.now.near) {
    if (rows.slopes) slope_loop(density, rows.now, rows.slopes, packs);
    return even ? explicit_loop<reach, true, false, Pack>(density, rows, packs)
                : explicit_loop<reach, false, false, Pack>(density, rows, packs);
  }
  if (rows.slopes)
    return even ? explicit_loop<reach, true, true, NearPack>(density, rows, packs)
                : explicit_loop<reach, false, true, NearPack>(density, rows, packs);
  return even ? explicit_loop<reach, true, false, NearPack>(density, rows, packs)
              : explicit_loop<reach, false, false, NearPack>(density, rows, packs);
}

}  // namespace delf
