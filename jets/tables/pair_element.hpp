// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <vector>

#include "jets/tables/stencil_table.hpp"
#include "jets/tables/splitting.hpp"

namespace delf {

/// Pairs of sites as far apart as this make space of order 12.
inline constexpr int widest_pair = 6;

/// What the pairs {i, i + m}, m = 1 … p, weigh in the action of order 2p:
///
///     m² β_m = 2 (−1)^{m+1} p!² / ((p − m)! (p + m)!),    Σ_m m² β_m = 1
///
inline std::vector<double> pair_weights(int p) {
  std::vector<double> weights;
  double quotient = 2;  // 2 p!² / ((p − m)! (p + m)!)
  for (int m = 1; m <= p; ++m) {
    quotient *= static_cast<double>(p - m + 1) / (p + m);
    weights.push_back(m % 2 == 1 ? quotient : -quotient);
  }
  return weights;
}

/// One step of a splitting over wide stencils, anchored at a site i: nodes are the rows between the sub-steps. In
/// sub-step s, of the length a_s h, with D_m = (y_{i+m} − y_i)/(mk),
///
///     L = Σ_m m² β_m Σ ½ w ℓ(φ, φ_t, D_m)       over both ends of a pair and both rows of the sub-step,
///
/// where φ, and φ_t = (y_above − y)/(a_s h), are those of the end and D_m that of the row: explicit where ℓ is
/// ½φ_t² plus a function of φ and φ_x. The rows' weights w sum to a_s in a sub-step, and to the kick b at a row:
/// leapfrog with its halves where both are alike. Weights may be negative: a sub-step goes back then, and its measure
/// is negative. Any density: each of the pairs alone is the average of ℓ over its two ends.
///
///     row 1      ○ ○ ○      p = 2. The unit cell has S nodes, one above the other: ● the vertex, ∘ between sub-steps.
///     nodes      ∘ ○ ○
///     row 0      ● ○ ○
///
inline StencilTable pair_element(const Splitting& splitting, int p) {
  const std::vector<double>& fractions = splitting.drifts;
  const int S = static_cast<int>(fractions.size()), width = p + 1;
  const std::vector<double> pairs = pair_weights(p);
  StencilTable element{.pattern = {}, .points = {}, .nodes = {}};
  double time = 0;
  std::vector<double> times;
  for (const double fraction : fractions) {
    times.push_back(time);
    element.nodes.push_back({time, 0});
    time += fraction;
  }
  times.push_back(1);
  for (int s = 0; s <= S; ++s)
    for (int m = 0; m <= p; ++m) element.pattern.vertices.push_back({.time = s / S, .space = m, .node = s % S});

  const auto size = element.pattern.vertices.size();
  const auto vertex = [width](int s, int m) { return static_cast<std::size_t>(s * width + m); };
  double lower = 0, upper = 0;  // w of the two rows of a sub-step
  for (int s = 0; s < S; ++s) {
    const double fraction = fractions[static_cast<std::size_t>(s)];
    lower = splitting.kicks[static_cast<std::size_t>(s)] - upper;
    upper = fraction - lower;
    for (int m = 1; m <= p; ++m)
      for (const int row : {s, s + 1})
        for (const int end : {0, m}) {
          std::vector phi(size, 0.0), phi_t(size, 0.0), phi_x(size, 0.0);
          phi[vertex(row, end)] = 1;
          phi_t[vertex(s + 1, end)] = 1 / fraction;
          phi_t[vertex(s, end)] = -1 / fraction;
          phi_x[vertex(row, m)] = 1. / m;
          phi_x[vertex(row, 0)] = -1. / m;
          TablePoint point{.weight = (row == s ? lower : upper) * pairs[static_cast<std::size_t>(m - 1)] / 2,
                           .time = times[static_cast<std::size_t>(row)],
                           .space = static_cast<double>(end),
                           .slots = {}};
          point.set(JetSlot::phi, phi), point.set(JetSlot::phi_t, phi_t), point.set(JetSlot::phi_x, phi_x);
          element.points.push_back(std::move(point));
        }
  }
  for (int m = 1; m <= p; ++m)
    for (const int end : {0, m}) {
      std::vector phi(static_cast<std::size_t>(width), 0.0), phi_x = phi;
      phi[static_cast<std::size_t>(end)] = 1;
      phi_x[static_cast<std::size_t>(m)] = 1. / m;
      phi_x[0] = -1. / m;
      TablePoint point{.weight = pairs[static_cast<std::size_t>(m - 1)] / 2,
                       .time = 0,
                       .space = static_cast<double>(end),
                       .slots = {}};
      point.set(JetSlot::phi, phi), point.set(JetSlot::phi_x, phi_x);
      element.lower_side.push_back(std::move(point));
    }
  return element;
}

}  // namespace delf
