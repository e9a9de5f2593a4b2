// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

namespace delf {

/// A symmetry of a density that acts on its d components alone, by an infinitesimal affine map: ℓ does not change along
///
///     φ ↦ φ + ε ξ(φ),   φ_t ↦ φ_t + ε A φ_t,   φ_x ↦ φ_x + ε A φ_x,   ξ(y) = A y + b
///
/// A density lists what it has by `static std::vector<LinearSymmetry> symmetries()`.
struct LinearSymmetry {
  std::string name;
  std::vector<double> matrix;  ///< A, d×d, row by row
  std::vector<double> shift;   ///< b, d
};

}  // namespace delf
