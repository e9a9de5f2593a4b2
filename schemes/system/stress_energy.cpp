// SPDX-License-Identifier: MIT
#include "schemes/system/stress_energy.hpp"

#include <algorithm>
#include <limits>

#include "jets/simd/scratch_rows.hpp"

namespace delf {

StressEnergy stress_energy(const BatchDensity& density, const double* at, double t, double x) {
  const int d = density.components(), m = density.variables();
  const ScratchRows jet(m + 1, lanes), g(m, lanes), l(3, lanes);
  for (int a = 0; a < m; ++a) std::fill_n(jet[a], lanes, at[a]);
  std::fill_n(jet[m], lanes, x);
  const JetBatch batch{lanes, jet.data(), t, jet[m]};
  density.gradient(batch, g.data(), l[0]);
  density.place_gradient(batch, l[1], l[2]);
  StressEnergy s{-l[0][0], 0, 0, l[0][0], l[1][0], l[2][0]};
  for (int a = 0; a < d; ++a) {
    const double phi_t = at[d + a], phi_x = at[2 * d + a];
    s.energy += phi_t * g[d + a][0];
    s.energy_flux += phi_t * g[2 * d + a][0];
    s.momentum -= phi_x * g[d + a][0];
    s.momentum_flux -= phi_x * g[2 * d + a][0];
    if (density.slots() == 3) continue;
    const double phi_tx = at[4 * d + a], phi_xx = at[5 * d + a];
    s.energy += phi_tx * g[4 * d + a][0];
    s.momentum -= phi_xx * g[4 * d + a][0];
    s.energy_flux = s.momentum_flux = std::numeric_limits<double>::quiet_NaN();
  }
  return s;
}

}  // namespace delf
