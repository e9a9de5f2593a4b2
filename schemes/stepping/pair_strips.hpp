// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <type_traits>
#include <utility>

#include "jets/simd/pack.hpp"
#include "jets/tables/pair_element.hpp"

namespace delf {

// Sums over pairs of sites along some packs of a row by lanes: neighbours are neighbouring packs. R or Q is how far apart
// pairs are, known where they are compiled: they are then loaded directly, with their weights in registers.

/// A strip of a row in a sub-step.
struct Strip {
  int packs;
  const double* linear;
  int reach;
  double nonlinear, stride;
  const double *D, *y, *slope;  ///< slope: null without source terms
  double *u, *next, *next_D;
};

/// Pairs of up to R sites apart, loaded directly; 0: of any number. `last` is the value before the strip, and then its last.
template <int R>
void step_strip(const Strip& given, Pack& last_value, Pack& largest_value) {
  const Strip rows = given;  // stores cannot change it
  const int reach = R > 0 ? R : rows.reach;
  Pack weights[R > 0 ? R : 1];
  for (int j = 0; j < R; ++j) weights[j] = Pack(rows.linear[j]);
  Pack last = last_value, largest = largest_value;
  for (std::ptrdiff_t at = 0; at < rows.packs * lanes; at += lanes) {
    Pack force = Pack::load(rows.u + at);
    if (rows.slope) force += rows.nonlinear * Pack::load(rows.slope + at);
    for (int j = 0; j < reach; ++j)
      force += (R > 0 ? weights[R > 0 ? j : 0] : Pack(rows.linear[j])) *
               (Pack::load(rows.D + at + j * lanes) - Pack::load(rows.D + at - (j + 1) * lanes));
    const Pack value = Pack::load(rows.y + at) + rows.stride * force;
    largest = largest_magnitude(largest, value);
    force.store(rows.u + at);
    value.store(rows.next + at);
    // The first of these lies in the halo, which is filled afterwards.
    (value - last).store(rows.next_D + at - lanes);
    last = value;
  }
  last_value = last, largest_value = largest;
}

/// f of the constant `reach`, as far as pairs go; of 0 beyond that.
void with_reach(int reach, const auto& f) {
  static_assert(widest_pair == 10);
  const auto constant = [&]<int... R>(std::integer_sequence<int, R...>) {
    const bool known = ((reach == R + 1 ? (f(std::integral_constant<int, R + 1>()), true) : false) || ...);
    if (!known) f(std::integral_constant<int, 0>());
  };
  constant(std::make_integer_sequence<int, widest_pair>());
}

/// Σ_j weights(j) (D(i + j) − D(i − 1 − j)) of some packs.
template <int R>
void sum_pairs(int packs, const double* weights, int reach, const double* D, double* out) {
  Pack w[R > 0 ? R : 1];
  for (int j = 0; j < R; ++j) w[j] = Pack(weights[j]);
  for (std::ptrdiff_t at = 0; at < packs * lanes; at += lanes) {
    Pack sum(0.0);
    for (int j = 0; j < (R > 0 ? R : reach); ++j)
      sum += (R > 0 ? w[R > 0 ? j : 0] : Pack(weights[j])) *
             (Pack::load(D + at + j * lanes) - Pack::load(D + at - (j + 1) * lanes));
    sum.store(out + at);
  }
}

/// u += kick (by_phi + Σ_m weights(m − 1) (G(i + m) − 2G(i) + G(i − m))) of some packs.
template <int Q>
void add_squares(int packs, double kick, const double* weights, int reach, const double* by_phi, const double* G,
                 double* u) {
  Pack w[Q > 0 ? Q : 1];
  for (int j = 0; j < Q; ++j) w[j] = Pack(weights[j]);
  for (std::ptrdiff_t at = 0; at < packs * lanes; at += lanes) {
    Pack sum = Pack::load(by_phi + at);
    const Pack here = Pack::load(G + at);
    for (int m = 1; m <= (Q > 0 ? Q : reach); ++m)
      sum += (Q > 0 ? w[Q > 0 ? m - 1 : 0] : Pack(weights[m - 1])) *
             ((Pack::load(G + at + m * lanes) - here) - (here - Pack::load(G + at - m * lanes)));
    (Pack::load(u + at) + kick * sum).store(u + at);
  }
}

}  // namespace delf
