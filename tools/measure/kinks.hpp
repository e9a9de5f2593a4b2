// SPDX-License-Identifier: MIT
#pragma once
#include "tools/measure/measurement.hpp"

namespace delf {

/// A place where a row passes a level between two vacua.
struct KinkAt {
  double x;
  int sign;  ///< 1 where φ rises, −1 where it falls
};

/// The kinks of a row from left to right: where φ passes one of the levels, which rise, or for an angle the first one
/// modulo 2π. x is that of a straight line between two sites.
std::vector<KinkAt> kinks_of(const MeasuredField&, std::span<const double> row, std::span<const double> levels);

/// The levels halfway between vacua: π of an angle; of a density in text those between the minima of −ℓ(φ, 0, 0) near the
/// range of the row; 0 where that has fewer than two, and of other theories, as of phi4.
std::vector<double> levels_between_vacua(const MeasuredField&, std::span<const double> row);

}  // namespace delf
