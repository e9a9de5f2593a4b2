// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/contraction.hpp"

#include <algorithm>

#include "jets/simd/pack.hpp"

namespace delf {

Contraction::Contraction(const RowEquations& equations, std::vector<std::vector<double>> gains)
    : equations_(equations), gains_(std::move(gains)) {}

double Contraction::within(double size, std::int64_t n) {
  if (!(size > size_ && size < 1e100)) return within_;
  constexpr double margin = 1.5;
  size_ = margin * size;
  within_ = std::max(within_, of(equations_.slopes_within(size_, n)));
  return within_;
}

/// The root of the step sh is near y_n + s v_n + s² (v_{n+1} − v_n).
bool Contraction::is_stiff_along(const RowTable& table, std::int64_t n) {
  along_ = 0;
  for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) along_ = larger_or_nan(of(equations_.slopes_at(table, n, s)), along_);
  return !(along_ < single_root);
}

double Contraction::of(const std::vector<double>& slopes) const {
  double worst = 0;
  for (std::size_t a = 0; !gains_.empty() && a < gains_[0].size(); ++a) {
    double sum = 0;
    for (std::size_t s = 0; s < slopes.size(); ++s)
      if (slopes[s] != 0) sum += gains_[s][a] * slopes[s];
    worst = larger_or_nan(sum, worst);
  }
  return worst;
}

}  // namespace delf
