// SPDX-License-Identifier: MIT
#include "schemes/stability/stable_set.hpp"

#include <cmath>

#include "schemes/stability/linear_stability.hpp"

namespace delf {

std::vector<StableInterval> stable_set(const std::function<LatticeSystem(double)>& make, double least, double most,
                                       const StableSearch& search) {
  const auto stable = [&](double x) { return linear_stability(make(x), search.constant, search.wave_numbers).stable; };
  /// The end, between a and b, of the property that holds at a.
  const auto end = [&](double a, double b) {
    const bool at_a = stable(a);
    while (std::abs(b - a) > search.tolerance) {
      const double middle = 0.5 * (a + b);
      if (middle == a || middle == b) break;
      (stable(middle) == at_a ? a : b) = middle;
    }
    return 0.5 * (a + b);
  };
  std::vector<StableInterval> set;
  double before = least;
  bool was = false;
  for (int i = 1; i <= search.samples; ++i) {
    const double x = least + (most - least) * i / search.samples;
    const bool is = stable(x);
    if (is && !was) set.push_back({i == 1 ? least : end(before, x), x});
    if (is) set.back().to = x;
    if (!is && was) set.back().to = end(before, x);
    before = x, was = is;
  }
  return set;
}

}  // namespace delf
