// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/families/stencil_family.hpp"

namespace delf {

/// Σ_a |∂G/∂φ_a φ_a|: the terms of G, which cancel within one site, and what G is small against.
inline double constraint_terms(std::span<const double> slopes, std::span<const double> fields) {
  double terms = 0;
  for (std::size_t a = 0; a < slopes.size(); ++a) terms += std::abs(slopes[a] * fields[a]);
  return terms;
}

/// G_m(φ) and ∂G_m/∂φ of a family L = Σ_m λ_m G_m(φ) on the values of one site: with λ_m = 1 and the others 0 they are its
/// residuals, by λ_m and by φ.
class ConstraintSlopes {
 public:
  ConstraintSlopes(const StencilFamily& constraint, std::size_t fields)
      : constraint_(constraint), fields_(fields), y_(delf::at(constraint.size())), r_(y_.size()) {}

  std::size_t constraints() const { return y_.size() - fields_; }
  /// G_m at these fields; slopes() are then of that.
  double at(std::size_t m, std::span<const double> fields) {
    std::ranges::copy(fields, y_.begin());
    std::fill(y_.begin() + static_cast<std::ptrdiff_t>(fields_), y_.end(), 0.0);
    y_[fields_ + m] = 1;
    constraint_.residual(Cell{}, y_, r_);
    return r_[fields_ + m];
  }
  std::span<const double> slopes() const { return {r_.data(), fields_}; }

 private:
  const StencilFamily& constraint_;
  std::size_t fields_;
  std::vector<double> y_, r_;
};

}  // namespace delf
