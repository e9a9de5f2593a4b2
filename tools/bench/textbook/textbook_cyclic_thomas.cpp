// SPDX-License-Identifier: MIT
#include "tools/bench/textbook/textbook_cyclic_thomas.hpp"

#include "lattice/index.hpp"

namespace delf::bench {

CyclicThomas::CyclicThomas(int sites, double a, double b)
    : sites_(sites), corner_(-b / a), inverse_(at(sites)), up_(inverse_), z_(inverse_) {
  const std::size_t last = at(sites) - 1;
  double above = 0;
  for (std::size_t i = 0; i <= last; ++i) {
    const double diagonal = i == 0 ? 2 * a : i == last ? a + b * b / a : a;
    inverse_[i] = 1 / (diagonal - b * above);
    above = up_[i] = b * inverse_[i];
  }
  z_[0] = -a, z_[last] = b;
  solve_without_corners(z_.data());
  const double scale = 1 / (1 + z_[0] + corner_ * z_[last]);
  for (double& z : z_) z *= scale;
}

void CyclicThomas::solve_without_corners(double* x) const {
  const double *inverse = inverse_.data(), *up = up_.data();
  double before = 0;
  for (int i = 0; i < sites_; ++i) before = x[i] = inverse[i] * x[i] - up[i] * before;
  for (int i = sites_ - 2; i >= 0; --i) before = x[i] -= up[i] * before;
}

void CyclicThomas::solve(double* x) const {
  solve_without_corners(x);
  const double* z = z_.data();
  const double along = x[0] + corner_ * x[sites_ - 1];
  for (int i = 0; i < sites_; ++i) x[i] -= along * z[i];
}

}  // namespace delf::bench
