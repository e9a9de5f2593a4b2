// SPDX-License-Identifier: MIT
#pragma once
#include "tools/measure/measurement.hpp"

namespace delf {

/// A place where a row passes a level between two vacua.
struct KinkAt {
  double x;
  int sign;  ///< 1 where φ rises, −1 where it falls
};

/// The kinks of a row from left to right: where φ passes the level, or for an angle the level modulo 2π. x is that of a
/// straight line between two sites.
std::vector<KinkAt> kinks_of(const MeasuredField&, std::span<const double> row, double level);

}  // namespace delf
