// SPDX-License-Identifier: MIT
#include "schemes/verify/fitted_multipliers.hpp"

#include <Eigen/Dense>
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
  const auto values = (*family)->values();
  ConstraintSlopes G(**family, d);
  const auto m = static_cast<int>(G.constraints());
  Eigen::MatrixXd slopes(m, static_cast<int>(d));
  Eigen::VectorXd force(static_cast<int>(d));
  const auto lambda = [&](std::vector<double>& y, std::size_t site, int b) -> double& {
    return y[site * C + at(values[d + at(b)].component)];
  };
  AssembledRow of_row(system);
  std::vector<LatticeSystem::Value> F;
  for (std::int64_t row = rows.first_row + system.height(); row <= rows.last_row() - system.height(); ++row) {
    std::vector<double>& y = rows.rows[at(row - rows.first_row)];
    for (std::size_t i = 0; i * C < y.size(); ++i)
      for (int b = 0; b < m; ++b) lambda(y, i, b) = 0;
    of_row.equations(rows, row, F);
    for (std::size_t i = 0; i * C < y.size(); ++i) {
      if (system.lattice().is_fixed(static_cast<int>(i))) continue;
      for (int b = 0; b < m; ++b) {
        G.at(at(b), std::span(y).subspan(i * C, d));
        for (std::size_t a = 0; a < d; ++a) slopes(b, static_cast<int>(a)) = G.slopes()[a];
      }
      for (std::size_t a = 0; a < d; ++a) force[static_cast<int>(a)] = F[i * C + a].sum;
      const Eigen::VectorXd fitted = (slopes * slopes.transpose()).fullPivLu().solve(Eigen::VectorXd(slopes * -force));
      for (int b = 0; b < m; ++b) lambda(y, i, b) = fitted[b];
    }
  }
}

}  // namespace delf
