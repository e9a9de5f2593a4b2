// SPDX-License-Identifier: MIT
#include "tools/diagnosis/scheme/momentum_scale.hpp"

#include <algorithm>
#include <cmath>

namespace delf {

MomentumScale momentum_scale(const Evidence& e, const std::vector<double>& masses) {
  const double k = e.system.lattice().space_step(), h = e.system.time_step();
  std::vector<MomentumScale> known{{"p is φ_t", std::vector<double>(masses.size(), 1.0)},
                                   {"p is ∂ℓ/∂φ_t", masses},
                                   {"p is ∂L/∂φ_t of a site", masses}};
  for (double& m : known[1].scale) m /= k;
  MomentumScale best;
  double least = 0.25;
  for (MomentumScale& one : known) {
    double off = 0, all = 0;
    for (int n = 1; n <= 5; ++n) {
      const std::int64_t j = std::clamp<std::int64_t>((e.rows - 1) * n / 6, 1, e.rows - 2);
      const auto before = e.row(j - 1), after = e.row(j + 1), p = e.momenta(j);
      for (std::size_t i = 0; i < p.size(); ++i) {
        const double v = (after[i] - before[i]) / (2 * h);
        off += std::abs(p[i] - one.scale[i] * v), all += std::abs(p[i]) + std::abs(one.scale[i] * v);
      }
    }
    if (off < least * all) least = off / all, best = std::move(one);
  }
  return best;
}

}  // namespace delf
