// SPDX-License-Identifier: MIT
#include "schemes/extrapolation.hpp"

#include <boost/math/special_functions/binomial.hpp>

namespace delf {

double extrapolation_weight(int rows, int j) {
  const double ways = boost::math::binomial_coefficient<double>(static_cast<unsigned>(rows), static_cast<unsigned>(j));
  return j % 2 == 0 ? -ways : ways;
}

}  // namespace delf
