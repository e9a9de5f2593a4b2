// SPDX-License-Identifier: MIT
#include "tools/run/field_error.hpp"

#include <cmath>

namespace delf {

FieldError field_error(std::span<const double> field, std::span<const double> solution, double space_step) {
  double largest = 0, squares = 0;
  for (std::size_t i = 0; i < field.size(); ++i) {
    const double e = std::abs(field[i] - solution[i]);
    if (e > largest || std::isnan(e)) largest = e;  // a NaN stays
    squares += e * e;
  }
  return {largest, std::sqrt(space_step * squares)};
}

}  // namespace delf
