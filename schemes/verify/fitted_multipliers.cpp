// SPDX-License-Identifier: MIT
#include "schemes/verify/fitted_multipliers.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/system/assembled_row.hpp"
#include "schemes/system/constraint_slopes.hpp"
#include "schemes/verify/region_system.hpp"

namespace delf {

void fit_multipliers(const LatticeSystem& system, Window& rows) {
  const auto family =
      std::ranges::find_if(system.families(), [&](const auto& f) { return has_multiplier(system, *f); });
  const std::size_t d = at(system.fields()), C = at(system.components());
  const std::size_t lambda = at((*family)->values().back().component);
  ConstraintSlopes G(**family, d);
  AssembledRow of_row(system);
  std::vector<LatticeSystem::Value> F;
  for (std::int64_t row = rows.first_row + system.height(); row <= rows.last_row() - system.height(); ++row) {
    std::vector<double>& y = rows.rows[at(row - rows.first_row)];
    for (std::size_t n = lambda; n < y.size(); n += C) y[n] = 0;
    of_row.equations(rows, row, F);
    for (std::size_t i = 0; i * C < y.size(); ++i) {
      if (system.lattice().is_fixed(static_cast<int>(i))) continue;
      G.at(0, std::span(y).subspan(i * C, d));
      double product = 0, square = 0;
      for (std::size_t a = 0; a < d; ++a)
        product += F[i * C + a].sum * G.slopes()[a], square += G.slopes()[a] * G.slopes()[a];
      if (square > 0) y[i * C + lambda] = -product / square;
    }
  }
}

}  // namespace delf
