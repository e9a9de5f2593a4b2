// SPDX-License-Identifier: MIT
#include "schemes/system/constant_mass.hpp"

namespace delf {

std::optional<Eigen::MatrixXd> constant_mass(const BatchDensity& density) {
  const int d = density.components();
  Eigen::MatrixXd mass(d, d);
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b) {
      if (!density.is_constant(d + a, d + b)) return std::nullopt;
      mass(a, b) = density.constant_hessian()[(d + a) * density.variables() + d + b];
    }
  return mass;
}

}  // namespace delf
