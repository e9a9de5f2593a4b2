// SPDX-License-Identifier: MIT
#include "schemes/stepping/energy.hpp"

#include <algorithm>

#include "jets/simd/scratch_rows.hpp"
#include "schemes/system/stress_energy.hpp"

namespace delf {

EnergyMomentum energy_momentum(const BatchDensity& density, const RowPair& pair, const double* cells) {
  constexpr int strip = 32;
  const int d = density.components(), m = density.variables();
  const RowLayout& layout = *pair.layout;
  const ScratchRows jet(m + 1, strip * lanes), g(m + 1, strip * lanes);
  for (int a = 3 * d; a < m; ++a) std::fill_n(jet[a], strip * lanes, 0.0);
  const double per_h = 0.5 / pair.time_step, per_k = 0.5 / pair.space_step;
  Pack energy(0.0), momentum(0.0);
  for (int first = 0; first < layout.packs(); first += strip) {
    const int packs = std::min(strip, layout.packs() - first);
    for (int p = 0; p < packs; ++p) {
      const std::ptrdiff_t from = layout.at(first + p), to = p * lanes;
      for (int a = 0; a < d; ++a) {
        const double *const y = pair.rows[a] + from, *const step = pair.rows[2 * d + a] + from;
        const Pack y_0 = Pack::load(y), y_1 = Pack::load(y + lanes);
        const Pack v_0 = Pack::load(step), v_1 = Pack::load(step + lanes);
        // φ, φ_t and φ_x in the middle of the cell, y_{j+1} = y_j + v
        (0.5 * (y_0 + y_1) + 0.25 * (v_0 + v_1)).store(jet[a] + to);
        (per_h * (v_0 + v_1)).store(jet[d + a] + to);
        (per_k * (2.0 * (y_1 - y_0) + (v_1 - v_0))).store(jet[2 * d + a] + to);
      }
      if (pair.positions) (Pack::load(pair.positions + from) + 0.5 * pair.space_step).store(jet[m] + to);
    }
    density.gradient({packs * lanes, jet.data(), pair.t + 0.5 * pair.time_step, jet[m]}, g.data(), g[m]);
    for (int p = 0; p < packs; ++p) {
      const std::ptrdiff_t at = p * lanes;
      Pack h = -Pack::load(g[m] + at), q(0.0);
      for (int a = 0; a < d; ++a) {
        const Pack by_t = Pack::load(g[d + a] + at);
        h += Pack::load(jet[d + a] + at) * by_t;
        q -= Pack::load(jet[2 * d + a] + at) * by_t;
      }
      const Pack weight = Pack::load(cells + layout.at(first + p));
      energy += weight * h, momentum += weight * q;
    }
  }
  return {pair.space_step * sum(energy), pair.space_step * sum(momentum)};
}

EnergyMomentum energy_momentum(const BatchDensity& density, const Lattice& lattice, CellJets& jets,
                               std::span<const double> below, std::span<const double> above, double t) {
  const double k = lattice.space_step();
  EnergyMomentum sums;
  for (int i = 0; i < lattice.cells(); ++i) {
    const StressEnergy s = stress_energy(density, jets.at(i, below, above), t, lattice.position(i) + 0.5 * k);
    sums.energy += k * s.energy, sums.momentum += k * s.momentum;
  }
  return sums;
}

}  // namespace delf
