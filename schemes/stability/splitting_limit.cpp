// SPDX-License-Identifier: MIT
#include "schemes/stability/splitting_limit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "jets/tables/suited_pairs.hpp"

namespace delf {
namespace {

/// The first h at which |trace| > 2, or `most`. Traces touch 2 where waves of two steps meet: rounding there is no growth.
double first_unstable(const Splitting& splitting, double lambda, double mu, double most) {
  constexpr int samples = 2000;
  constexpr double rounding = 1e-12;
  const auto stable = [&](double h) {
    return std::abs(step_trace(splitting, h * h * lambda, h * h * mu)) <= 2 + rounding;
  };
  for (int i = 1; i <= samples; ++i) {
    double low = most * (i - 1) / samples, high = most * i / samples;
    if (stable(high)) continue;
    for (int n = 0; n < 50; ++n) (stable(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
    return low;
  }
  return most;
}

}  // namespace

/// A kick of b: p −= b (λ − 2g μ²) y, as its action has −½λy² + g(μy)²; a drift of a: y += a p.
double step_trace(const Splitting& splitting, double lambda, double mu) {
  double trace = 0;
  for (const int column : {0, 1}) {
    double y = column == 0 ? 1 : 0, p = 1 - y;
    for (std::size_t s = 0; s < splitting.kicks.size(); ++s) {
      p -= splitting.kicks[s] * (lambda - 2 * splitting.gradient * mu * mu) * y;
      if (s < splitting.drifts.size()) y += splitting.drifts[s] * p;
    }
    trace += column == 0 ? y : p;
  }
  return trace;
}

double frequency_limit(const Splitting& splitting) { return first_unstable(splitting, 1, 1, 20); }

double courant_limit(const Splitting& splitting, const std::vector<double>& pairs,
                     const std::vector<double>& force_pairs, double mass_k) {
  constexpr int waves = 200;
  double limit = 20;
  for (int j = waves; j >= 1; --j) {
    const double theta = std::numbers::pi * j / waves, m = mass_k * mass_k;
    limit = first_unstable(splitting, pair_symbol(pairs, theta) + m, pair_symbol(force_pairs, theta) + m, limit);
  }
  return limit;
}

}  // namespace delf
