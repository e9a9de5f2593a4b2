// SPDX-License-Identifier: MIT
#include "schemes/system/conserved.hpp"

#include <algorithm>
#include <cmath>

#include "lattice/error.hpp"

namespace delf {

void generator(const LatticeSystem& system, const StencilFamily& family, const LinearSymmetry& symmetry,
               std::span<const double> y, std::vector<double>& xi) {
  const auto& values = family.values();
  const std::size_t d = symmetry.shift.size();
  xi.assign(values.size(), 0.0);
  for (std::size_t n = 0; n < values.size(); ++n) {
    if (system.component(values[n].component).role == Role::multiplier) continue;
    const std::size_t a = static_cast<std::size_t>(values[n].component) % d;
    // ξ_a = Σ_b A_ab y_b + b_a
    xi[n] = symmetry.shift[a];
    for (std::size_t b = 0; b < d; ++b) {
      if (symmetry.matrix[a * d + b] == 0) continue;
      const VertexValue wanted{values[n].vertex, values[n].component + static_cast<int>(b) - static_cast<int>(a)};
      const auto found = std::ranges::find(values, wanted);
      if (found == values.end())
        throw BadInput("verify.generator", "a stencil does not read " + system.component(wanted.component).name +
                                               " where the generator needs it; leave it out");
      xi[n] += symmetry.matrix[a * d + b] * y[static_cast<std::size_t>(found - values.begin())];
    }
  }
}

double noether_charge(const LatticeSystem& system, const Window& window, std::int64_t cut,
                      const LinearSymmetry& symmetry, double* absolute) {
  const Lattice& lattice = system.lattice();
  double sum = 0;
  if (absolute) *absolute = 0;
  std::vector<double> y, r, xi;
  for (const auto& family : system.families()) {
    const auto& vertices = family->pattern().vertices;
    const auto [low, high] = std::ranges::minmax(vertices, {}, &Site::time);
    for (std::int64_t row = cut - high.time; row + low.time < cut; ++row)
      for (int i = 0; i < lattice.sites(); ++i) {
        if (!system.has_stencil(*family, row, i)) continue;
        const Cell cell = system.gather(*family, window, row, i, system.time_step(), y);
        r.resize(y.size());
        family->residual(cell, y, r);
        generator(system, *family, symmetry, y, xi);
        for (int n = 0; n < family->size(); ++n) {
          if (row + family->site(n).time < cut) continue;
          const double term = r[static_cast<std::size_t>(n)] * xi[static_cast<std::size_t>(n)];
          sum += term;
          if (absolute) *absolute += std::abs(term);
        }
      }
  }
  return sum;
}

}  // namespace delf
