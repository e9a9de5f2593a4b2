// SPDX-License-Identifier: MIT
#include "schemes/conserved.hpp"

#include <algorithm>
#include <cmath>

namespace delf {

double noether_charge(const LatticeSystem& system, const Window& window, std::int64_t cut,
                      const LinearSymmetry& symmetry, double* absolute) {
  const Lattice& lattice = system.lattice();
  const int d = static_cast<int>(symmetry.shift.size());
  double sum = 0;
  if (absolute) *absolute = 0;
  std::vector<double> y, r;
  for (const auto& family : system.families()) {
    const auto& vertices = family->pattern().vertices;
    const auto [low, high] = std::ranges::minmax(vertices, {}, &Site::time);
    for (std::int64_t row = cut - high.time; row + low.time < cut; ++row)
      for (int i = 0; i < lattice.sites(); ++i) {
        if (!family->pattern().placed_at({static_cast<int>(row & 1), i})) continue;
        if (!lattice.is_circle() && std::ranges::any_of(vertices, [&](Site v) {
              return i + v.space < 0 || i + v.space >= lattice.sites();
            }))
          continue;
        y.clear();
        for (int n = 0; n < family->size(); ++n)
          y.push_back(window(row + family->site(n).time, i + family->site(n).space,
                             family->values()[static_cast<std::size_t>(n)].component));
        r.resize(y.size());
        family->residual({system.time_step(), lattice.space_step(), static_cast<double>(row) * system.time_step(),
                          lattice.position(i)},
                         y, r);
        for (int n = 0; n < family->size(); ++n) {
          const int c = family->values()[static_cast<std::size_t>(n)].component;
          if (row + family->site(n).time < cut || system.component(c).role == Role::multiplier) continue;
          // ξ acts alike at every node; the fields of one node stand together in the family's values.
          const int a = c % d, first = n - a;
          double xi = symmetry.shift[static_cast<std::size_t>(a)];
          for (int b = 0; b < d; ++b)
            xi += symmetry.matrix[static_cast<std::size_t>(a * d + b)] * y[static_cast<std::size_t>(first + b)];
          sum += r[static_cast<std::size_t>(n)] * xi;
          if (absolute) *absolute += std::abs(r[static_cast<std::size_t>(n)] * xi);
        }
      }
  }
  return sum;
}

}  // namespace delf
