// SPDX-License-Identifier: MIT
#include "schemes/system/tangent_momentum.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "schemes/system/legendre.hpp"

namespace delf {

std::vector<double> tangent_momentum(const BatchDensity& density, const StencilFamily& constraint,
                                     std::span<const double> q, std::vector<double> p, double t) {
  // L = λG: ∂L/∂q at λ = 1 is ∂G/∂q
  std::vector<double> y(q.begin(), q.end()), normal(q.size() + 1);
  y.push_back(1);
  constraint.residual(Cell{1, 1, t, 0}, y, normal);
  normal.pop_back();
  const auto moved = [&](double mu) {
    std::vector<double> sum = p;
    for (std::size_t a = 0; a < sum.size(); ++a) sum[a] += mu * normal[a];
    return sum;
  };
  const auto off = [&](double mu) {
    const auto v = velocity_of(density, q, moved(mu), t);
    return v ? std::inner_product(normal.begin(), normal.end(), v->begin(), 0.0)
             : std::numeric_limits<double>::quiet_NaN();
  };
  // The secant method: one step where ℓ is quadratic in q̇, and a second for its rounding.
  double a = 0, b = 1, at_a = off(a), at_b = off(b);
  for (int iteration = 0; iteration < 20 && at_b != at_a; ++iteration) {
    const double next = b - at_b * (b - a) / (at_b - at_a);
    if (!std::isfinite(next)) return p;
    a = b, at_a = at_b, b = next, at_b = off(b);
    if (std::abs(at_b) <= std::numeric_limits<double>::epsilon() * std::abs(at_a)) break;
  }
  return std::isfinite(at_b) ? moved(b) : p;
}

}  // namespace delf
