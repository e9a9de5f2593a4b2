// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "schemes/verify/equation_check.hpp"

namespace delf {

/// The precision that all values were rounded to, if it is coarser than double precision.
struct RoundedValues {
  std::string words;  ///< "6 decimals", "6 significant digits"
  double unit;        ///< the largest error of a value
  double relative;    ///< the same beside the largest value
  ValueError error;
};
std::optional<RoundedValues> rounding_of(const std::vector<std::vector<double>>& rows);
/// The rounding of `count` rows that can be read, by some of them.
std::optional<RoundedValues> rounding_of(std::int64_t count,
                                         const std::function<std::vector<double>(std::int64_t)>& row);

}  // namespace delf
