// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <vector>

namespace delf {

/// A state that knows all derivatives of its field. Those that do are of this class too.
class SmoothState {
 public:
  virtual ~SmoothState() = default;
  /// ∂ᵐ⁺ⁿφ_a/∂tᵐ∂xⁿ of all components at a point, at (o (o + 1)/2 + n) d + a with o = m + n, up to an order; nothing where
  /// that would take too long.
  virtual std::optional<std::vector<double>> jet(double t, double x, int order) const = 0;
};

}  // namespace delf
