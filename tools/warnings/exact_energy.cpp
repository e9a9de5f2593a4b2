// SPDX-License-Identifier: MIT
#include "tools/warnings/exact_energy.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "jets/simd/scratch_rows.hpp"
#include "lattice/index.hpp"

namespace delf {

std::optional<double> exact_energy(const State& state, const BatchDensity& density, const Lattice& lattice,
                                   double width, double t) {
  constexpr double most_cells = 4096;
  const int d = density.components(), m = density.variables();
  if (state.components() != d || density.slots() > 3) return std::nullopt;  // a state knows no second derivatives
  const bool point = lattice.space() == Space::point;
  const bool has_pulses = std::isfinite(width);
  // A wave may be two sites long; a pulse is resolved by two cells. A formula may be narrower than the cells of the lattice.
  constexpr double fine = 512;
  const double wanted = has_pulses ? std::max(64.0, std::ceil(2 * lattice.length() / width))
                                   : lattice.cells() * std::ceil(fine / lattice.cells());
  if (!(wanted <= most_cells)) return std::nullopt;
  const int cells = point ? 1 : static_cast<int>(wanted);
  const double cell = lattice.length() / cells;

  const ScratchRows jet(m + 1, lanes), g(m + 1, lanes);
  std::vector<FieldPoint> at(d);
  double energy = 0, weight_of[lanes];
  int filled = 0;
  const auto add = [&](double x, double weight) {
    state.at(t, x, at);
    for (int a = 0; a < d; ++a) {
      const FieldPoint& p = at[a];
      jet[a][filled] = p.phi, jet[d + a][filled] = p.phi_t, jet[2 * d + a][filled] = p.phi_x;
    }
    for (int a = 3 * d; a < m; ++a) jet[a][filled] = 0;
    jet[m][filled] = x;
    weight_of[filled++] = weight;
    if (filled < lanes) return;
    density.gradient({lanes, jet.data(), t, jet[m]}, g.data(), g[m]);
    for (int l = 0; l < lanes; ++l) {
      double h = -g[m][l];
      for (int a = 0; a < d; ++a) h += jet[d + a][l] * g[d + a][l];
      if (weight_of[l] != 0) energy += weight_of[l] * h;
    }
    filled = 0;
  };
  for (int c = 0; c < cells; ++c) add(lattice.position(0) + cell * (c + (point ? 0 : 0.5)), cell);
  while (filled > 0) add(lattice.position(0), 0);
  return energy;
}

}  // namespace delf
