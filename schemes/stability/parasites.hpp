// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "schemes/stability/symbol.hpp"

namespace delf {

/// A wave of a scheme that no field equation has: its roots tend to a corner of (θ, z) that a smooth field does not know,
///
///     (−1)^j: θ = 0, z = −1        (−1)^i: θ = π, z = 1        (−1)^(i+j): θ = π, z = −1
///
/// A scheme has the first where its equations reach over more rows than the theory has derivatives in time: potential
/// KdV, of first order in t, over three rows. It need not grow: ghosts that do are those of linear_stability.
struct Parasite {
  std::string wave;  ///< "(-1)^j"
  int roots;         ///< how many tend to the corner
};
/// None for mechanics' θ = π, nor for brick walls, whose (−z, θ + π) are the same mode.
std::vector<Parasite> parasites(const Symbol&);

}  // namespace delf
