// SPDX-License-Identifier: MIT
#include "schemes/system/stress_energy.hpp"

#include <algorithm>

#include "jets/simd/scratch_rows.hpp"

namespace delf {

StressEnergy stress_energy(const BatchDensity& density, const double* phi, const double* phi_t, const double* phi_x,
                           double t, double x) {
  const int d = density.components(), m = density.variables();
  const ScratchRows jet(m + 1, lanes), g(m, lanes), l(3, lanes);
  for (int a = 0; a < m; ++a) {
    const double* const slot = a < d ? phi : a < 2 * d ? phi_t : phi_x;
    std::fill_n(jet[a], lanes, a < 3 * d ? slot[a % d] : 0.0);
  }
  std::fill_n(jet[m], lanes, x);
  const JetBatch batch{lanes, jet.data(), t, jet[m]};
  density.gradient(batch, g.data(), l[0]);
  density.place_gradient(batch, l[1], l[2]);
  StressEnergy s{-l[0][0], 0, 0, l[0][0], l[1][0], l[2][0]};
  for (int a = 0; a < d; ++a) {
    s.energy += phi_t[a] * g[d + a][0];
    s.energy_flux += phi_t[a] * g[2 * d + a][0];
    s.momentum -= phi_x[a] * g[d + a][0];
    s.momentum_flux -= phi_x[a] * g[2 * d + a][0];
  }
  return s;
}

}  // namespace delf
