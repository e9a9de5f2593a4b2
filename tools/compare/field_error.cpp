// SPDX-License-Identifier: MIT
#include "tools/compare/field_error.hpp"

#include <cmath>

#include "lattice/error.hpp"

namespace delf {

FieldError field_error(std::span<const double> field, std::span<const double> solution, double space_step) {
  if (field.size() != solution.size())
    throw BadInput("scheme.method",
                   "scheme.method: its rows hold more than the fields, such as a mesh that moves, and are "
                   "not compared here; use delf run, which compares at the mesh");
  double largest = 0, squares = 0;
  for (std::size_t i = 0; i < field.size(); ++i) {
    const double e = std::abs(field[i] - solution[i]);
    if (e > largest || std::isnan(e)) largest = e;  // a NaN stays
    squares += e * e;
  }
  return {largest, std::sqrt(space_step * squares)};
}

}  // namespace delf
