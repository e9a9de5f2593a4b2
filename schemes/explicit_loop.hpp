// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "jets/density.hpp"
#include "schemes/row_kernel.hpp"
#include "schemes/value_jet.hpp"

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
/// written over the old one. Returns √Σy² of the new values: infinite or NaN where squares overflow.
///
/// `even`: stride is 1, and so far as one neighbour on either side is concerned linear(−1) = linear(1): a tenth less.
template <int reach, bool even, Density D>
[[gnu::flatten]] double explicit_loop(const D& given_density, const ExplicitRows& given, const PackRange& given_packs) {
  const PackRange packs = given_packs;
  constexpr int d = components_of<D>(), count = 2 * reach;
  // Copies of this function alone: what is stored through others cannot change them, so that they stay in registers.
  const D density = given_density;
  const double stride = given.stride;
  const double* const positions = given.now.positions;
  const Pack t(given.now.t);
  const std::ptrdiff_t origin = given.now.layout->at(0);
  std::array<const double*, d> now, v_before;
  std::array<double*, d> v_new, y_new;
  std::array<double, static_cast<std::size_t>(d * count)> linear;
  std::array<double, d> nonlinear;
  for (int a = 0; a < d; ++a) {
    now[a] = given.now.values[a], v_before[a] = given.v_before[a];
    v_new[a] = given.v[a], y_new[a] = given.y[a];
    nonlinear[a] = given.nonlinear[a];
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
  // Of this pack, or of the next one.
  const auto slope = [&](int beside, std::ptrdiff_t at) __attribute__((always_inline)) {
    const auto value = [&](int a) __attribute__((always_inline)) {
      if constexpr (reach == 0) return Pack::load(now[a] + at);
      else return y[a][reach + beside];
    };
    return density(value_jet<D>(value, t, positions + at)).d;
  };
  const auto take = [&](const auto& incoming) __attribute__((always_inline)) {
    for (int a = 0; a < d; ++a) {
      for (int s = 0; s < 2 * reach; ++s) y[a][s] = y[a][s + 1];
      y[a][2 * reach] = Pack::load(incoming(a));
    }
  };
  const auto advance = [&](std::ptrdiff_t at, const std::array<Pack, d>& here_slope) __attribute__((always_inline)) {
    for (int a = 0; a < d; ++a) {
      const Pack here = y[a][reach];
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
  // Slopes are evaluated one pack ahead: what waits for them would keep the next ones waiting.
  int v = packs.first;
  if (v >= packs.last) return 0;
  std::ptrdiff_t at = origin + static_cast<std::ptrdiff_t>(v) * lanes;
  take([&](int a) { return old_value(a, v + reach); });
  std::array<Pack, d> here = slope(0, at);
  for (; v + 1 + reach < packs.last; ++v, at += lanes) {
    const std::array<Pack, d> next = slope(1, at + lanes);
    advance(at, here);
    here = next;
    take([&](int a) { return now[a] + at + (1 + reach) * lanes; });
  }
  for (; v + 1 < packs.last; ++v, at += lanes) {
    const std::array<Pack, d> next = slope(1, at + lanes);
    advance(at, here);
    here = next;
    take([&](int a) { return old_value(a, v + 1 + reach); });
  }
  advance(at, here);
  return std::sqrt(sum(squares));
}

/// The loop that the coefficients allow.
template <int reach, Density D>
double explicit_loop_for(const D& density, const ExplicitRows& rows, const PackRange& packs) {
  bool even = rows.stride == 1;
  for (int a = 0; a < components_of<D>() && reach == 1; ++a) even = even && rows.linear[2 * a] == rows.linear[2 * a + 1];
  return even ? explicit_loop<reach, true>(density, rows, packs) : explicit_loop<reach, false>(density, rows, packs);
}

/// What is left of the same equation,
///
///     E = Σ_s linear(s) (y(i + s) − y(i)) + nonlinear ∂ℓ/∂φ(y(i)) − (v − v_before)(i)
template <int reach, Density D>
[[gnu::flatten]] void explicit_residual_loop(const D& given_density, const ExplicitRows& given, LargestTerms* terms) {
  constexpr int d = components_of<D>(), count = 2 * reach;
  // Copies of this function alone, which stay in registers.
  const D density = given_density;
  const double* const positions = given.now.positions;
  const Pack t(given.now.t);
  std::array<const double*, d> now, v_before, v;
  std::array<double, static_cast<std::size_t>(d * count)> linear;
  std::array<double, d> nonlinear;
  for (int a = 0; a < d; ++a) {
    now[a] = given.now.values[a], v_before[a] = given.v_before[a], v[a] = given.v[a];
    nonlinear[a] = given.nonlinear[a];
    for (int s = 0; s < count; ++s) linear[a * count + s] = given.linear[a * count + s];
  }
  std::array<LargestTerms, d> largest;
  const auto slope = [&](std::ptrdiff_t at) __attribute__((always_inline)) {
    return density(
        value_jet<D>([&](int a) __attribute__((always_inline)) { return Pack::load(now[a] + at); }, t, positions + at)).d;
  };
  std::ptrdiff_t at = given.now.layout->at(0);
  const std::ptrdiff_t last = given.now.layout->at(given.now.layout->packs() - 1);
  // y(i) − y(i − 1), and its size, where neighbours reach no further: the pack before has worked it out.
  struct Difference {
    Pack value, size;
  };
  const auto difference = [&](int a, std::ptrdiff_t to, std::ptrdiff_t from) __attribute__((always_inline)) {
    const Pack value = Pack::load(now[a] + to) - Pack::load(now[a] + from);
    return Difference{value, abs(value)};
  };
  std::array<Difference, d> before;
  for (int a = 0; a < d; ++a) before[a] = difference(a, at, at - lanes);
  // Slopes are evaluated one pack ahead: what waits for them would keep the next ones waiting.
  auto here = slope(at);
  for (; at <= last; at += lanes) {
    const auto next = slope(std::min(at + lanes, last));
    for (int a = 0; a < d; ++a) {
      const Pack w = Pack::load(v[a] + at) - Pack::load(v_before[a] + at);
      Pack E = -w, size = abs(w);
      const auto add = [&](double coefficient, const Difference& term) __attribute__((always_inline)) {
        E += coefficient * term.value;
        size += std::abs(coefficient) * term.size;
      };
      if constexpr (reach == 1) {
        const Difference after = difference(a, at + lanes, at);
        add(-linear[a * count], before[a]);
        add(linear[a * count + 1], after);
        before[a] = after;
      } else {
        for (int s = 0; s < count; ++s)
          add(linear[a * count + s],
              difference(a, at + neighbours_within<reach>[static_cast<std::size_t>(s)] * lanes, at));
      }
      const Pack slope_here = here[static_cast<std::size_t>(a)];
      add(nonlinear[a], {slope_here, abs(slope_here)});
      largest[a](at, E, size);
    }
    here = next;
  }
  for (int a = 0; a < d; ++a) terms[a] = largest[a];
}

}  // namespace delf
