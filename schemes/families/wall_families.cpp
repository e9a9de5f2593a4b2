// SPDX-License-Identifier: MIT
#include "schemes/families/wall_families.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "jets/simd/scratch_rows.hpp"
#include "jets/tables/wall_tables.hpp"
#include "lattice/error.hpp"
#include "lattice/stencil.hpp"

namespace delf {
namespace {

/// A natural wall has ∂ℓ/∂φ_x = 0. Whether that holds where φ_x = 0, at some jets of several sizes.
bool has_level_walls(const BatchDensity& density) {
  const int d = density.components(), m = density.variables();
  const ScratchRows jet(m, lanes), g(m, lanes), x(1, lanes);
  std::mt19937_64 engine(20250901);
  const auto number = [&] { return 2.0 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1.0; };
  for (double amplitude = 2; amplitude > 1e-3; amplitude /= 10) {
    for (int a = 0; a < m; ++a)
      for (int l = 0; l < lanes; ++l) jet[a][l] = a < 2 * d ? amplitude * number() : 0;
    for (int l = 0; l < lanes; ++l) x[0][l] = amplitude * number();
    density.gradient({lanes, jet.data(), amplitude, x[0]}, g.data());
    for (int l = 0; l < lanes; ++l) {
      double size = 0;
      for (int a = 0; a < m; ++a) size = std::max(size, std::abs(g[a][l]));
      // Where the density is not defined, the comparison is false.
      for (int a = 2 * d; a < 3 * d; ++a)
        if (std::abs(g[a][l]) > 1e-13 * size) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<std::shared_ptr<const StencilFamily>> wall_families(const StencilTable& table,
                                                                const std::shared_ptr<const BatchDensity>& density,
                                                                const Lattice& lattice) {
  std::vector<std::shared_ptr<const StencilFamily>> families;
  for (StencilTable& term : wall_tables(table)) {
    const int column = term.pattern.placement == Placement::left_wall ? 0 : lattice.sites() - 1;
    if (has_column(lattice, term.pattern, column))
      families.push_back(std::make_shared<JetFamily>(std::move(term), density));
  }
  if (!families.empty() && !has_level_walls(*density))
    throw BadInput("lattice.stencil",
                   "lattice.stencil: at natural walls this stencil needs phi_x = 0, and the density has another "
                   "natural condition; use rectangle or rectangle-symmetric, or fixed walls");
  return families;
}

}  // namespace delf
