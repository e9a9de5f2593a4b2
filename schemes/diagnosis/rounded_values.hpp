// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "schemes/diagnosis/evidence.hpp"

namespace delf {

/// What all values were rounded to, if it is coarser than double precision.
struct RoundedValues {
  std::string words;  ///< "6 decimals", "6 significant digits"
  double unit;        ///< the largest error of a value
};
std::optional<RoundedValues> rounding_of(const std::vector<std::vector<double>>& rows);
/// What that makes of equations, relative to their terms; 0 if the values have double precision.
double error_of_rounding(const Evidence&);

}  // namespace delf
