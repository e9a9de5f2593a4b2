// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "tools/diagnosis/evidence.hpp"

namespace delf {

/// The meaning of momenta in a file: φ_t = p / scale, [i·C + c].
struct MomentumScale {
  std::string words;          ///< "p is φ_t"
  std::vector<double> scale;  ///< empty: none of those that are known
};
/// Velocities, densities of momentum, or the momenta of sites ∂L/∂φ_t: which is nearest to the central differences of the
/// rows. Nothing fits where p is not within a quarter of any.
MomentumScale momentum_scale(const Evidence&, const std::vector<double>& masses);

}  // namespace delf
