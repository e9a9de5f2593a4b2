// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <type_traits>
#include <utility>

#include "jets/simd/pack.hpp"
#include "jets/tables/pair_element.hpp"

namespace delf {

// Sums over pairs of sites along some packs of a row by lanes: neighbours are neighbouring packs. R or Q is how far apart
// pairs are, known where they are compiled: weights are then kept in registers.

/// A strip of a row in a sub-step.
struct PairStrip {
  int packs;
  const double* linear;
  double nonlinear, stride;
  const double *D, *y, *slope;  ///< slope: null without source terms
  double *u, *next, *next_D;
};

/// The number of neighbouring packs that share what they load: a difference is loaded once for all, which halves the
/// time of wide sums (measured: 0.72 of a step of b6 over pairs to 8 apart).
inline constexpr int sharing = 4;

/// sum[b] += Σ_j weights(j) (D(i + b + j) − D(i + b − 1 − j)) for B packs from i on, j < R in this order.
template <int R, int B>
[[gnu::always_inline]] inline void add_pairs(const Pack* weights, const double* D, Pack* sum) {
  Pack above[B], below[B];
  for (int b = 0; b < B; ++b) above[b] = Pack::load(D + b * lanes), below[b] = Pack::load(D + (b - 1) * lanes);
#pragma GCC unroll 16
  for (int j = 0; j < R; ++j) {
    for (int b = 0; b < B; ++b) sum[b] += weights[j] * (above[b] - below[b]);
    if (j + 1 == R) break;
    for (int b = 0; b + 1 < B; ++b) above[b] = above[b + 1], below[B - 1 - b] = below[B - 2 - b];
    above[B - 1] = Pack::load(D + (B + j) * lanes), below[0] = Pack::load(D - (j + 2) * lanes);
  }
}
/// body(at, constant B) for all packs, B = `sharing` of them at once as long as there are so many.
template <class Body>
[[gnu::always_inline]] inline void for_sharing_packs(int packs, const Body& body) {
  std::ptrdiff_t at = 0;
  for (; at + (sharing - 1) * lanes < packs * lanes; at += sharing * lanes)
    body(at, std::integral_constant<int, sharing>());
  for (; at < packs * lanes; at += lanes) body(at, std::integral_constant<int, 1>());
}

/// Pairs of up to R sites apart. `last` is the value before the strip, and then its last.
template <int R>
void step_strip(const PairStrip& given, Pack& last_value, Pack& largest_value) {
  const PairStrip rows = given;  // stores cannot change it
  Pack weights[R];
  for (int j = 0; j < R; ++j) weights[j] = Pack(rows.linear[j]);
  Pack last = last_value, largest = largest_value;
  for_sharing_packs(rows.packs, [&]<int B>(std::ptrdiff_t first, std::integral_constant<int, B>) {
    Pack force[B];
    for (int b = 0; b < B; ++b) {
      force[b] = Pack::load(rows.u + first + b * lanes);
      if (rows.slope) force[b] += rows.nonlinear * Pack::load(rows.slope + first + b * lanes);
    }
    add_pairs<R, B>(weights, rows.D + first, force);
    for (int b = 0; b < B; ++b) {
      const std::ptrdiff_t at = first + b * lanes;
      const Pack value = Pack::load(rows.y + at) + rows.stride * force[b];
      largest = largest_magnitude(largest, value);
      force[b].store(rows.u + at);
      value.store(rows.next + at);
      // The first of these lies in the halo, which is filled afterwards.
      (value - last).store(rows.next_D + at - lanes);
      last = value;
    }
  });
  last_value = last, largest_value = largest;
}

/// f of the constant `reach`, 1 … widest_pair.
void with_reach(int reach, const auto& f) {
  const auto constant = [&]<int... R>(std::integer_sequence<int, R...>) {
    ((reach == R + 1 ? f(std::integral_constant<int, R + 1>()) : void()), ...);
  };
  constant(std::make_integer_sequence<int, widest_pair>());
}

/// Σ_j weights(j) (D(i + j) − D(i − 1 − j)) of some packs.
template <int R>
void sum_pairs(int packs, const double* weights, const double* D, double* out) {
  Pack w[R];
  for (int j = 0; j < R; ++j) w[j] = Pack(weights[j]);
  for_sharing_packs(packs, [&]<int B>(std::ptrdiff_t at, std::integral_constant<int, B>) {
    Pack sum[B];
    for (int b = 0; b < B; ++b) sum[b] = Pack(0.0);
    add_pairs<R, B>(w, D + at, sum);
    for (int b = 0; b < B; ++b) sum[b].store(out + at + b * lanes);
  });
}

/// u += kick (by_phi + Σ_m weights(m − 1) (G(i + m) − 2G(i) + G(i − m))) of some packs. A gradient is so much less than the
/// force that the sum need not be one of differences.
template <int Q>
void add_squares(int packs, double kick, const double* weights, const double* by_phi, const double* G, double* u) {
  Pack w[Q], centre(0.0);
  for (int m = 1; m <= Q; ++m) {
    w[m - 1] = Pack(kick * weights[m - 1]);
    centre -= 2.0 * w[m - 1];
  }
  for (std::ptrdiff_t at = 0; at < packs * lanes; at += lanes) {
    Pack sum = Pack::load(u + at) + (kick * Pack::load(by_phi + at) + centre * Pack::load(G + at));
    for (int m = 1; m <= Q; ++m) sum += w[m - 1] * (Pack::load(G + at + m * lanes) + Pack::load(G + at - m * lanes));
    sum.store(u + at);
  }
}

}  // namespace delf
