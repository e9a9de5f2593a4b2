// SPDX-License-Identifier: MIT
#include "tools/diagnosis/local/wall_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lattice/index.hpp"
#include "tools/diagnosis/least_squares.hpp"
#include "tools/diagnosis/own_equations.hpp"
#include "tools/diagnosis/sampled_rows.hpp"

namespace delf {

std::string wall_law(const Evidence& e, bool left) {
  const LatticeSystem& system = e.system;
  const int N = system.lattice().sites(), end = left ? 0 : N - 1, beyond = left ? N - 1 : 0, inside = left ? 1 : N - 2;
  if (system.components() != 1 || system.height() != 1 || system.width() != 1 || e.rows < 12) return {};
  double slope = 0;  // ∂E/∂φ₋₁
  for (const Coefficient& c : system.linearised({0, end}, 0)) {
    if (c.offset.space != (left ? -1 : 1)) continue;
    if (c.offset.time != 0 || c.dependence != Dependence::linear) return {};
    slope = c.value;
  }
  if (slope == 0) return {};
  const std::int64_t count = sampled_rows(e);
  Eigen::VectorXd target(count);
  std::vector<Eigen::VectorXd> columns(2, Eigen::VectorXd(count));
  const double k = system.lattice().space_step(), h = system.time_step();
  const double largest = look_at_sampled_rows(e, 0, [&](std::int64_t n, const auto& rows, const auto& E) {
    const auto at = [&](std::size_t row, int i) { return rows[row][i]; };
    const double ghost = at(1, beyond) - E[end].sum / slope;
    target[n] = (at(1, inside) - ghost) / (2 * k);
    columns[0][n] = at(1, end), columns[1][n] = (at(2, end) - at(0, end)) / (2 * h);
  });
  const double allowed = 100 * e.tolerance * scale_of_terms(system, largest) / std::abs(slope) / (2 * k);
  const auto text = [](double value) { return fmt::format("{:.6g}", value); };
  // The simplest that holds.
  if (const auto fit = least_squares(target, {columns[0]}); fit.remains <= allowed)
    return fmt::format("φ_x = {} φ, a Robin condition", text((left ? 1 : -1) * fit.coefficients[0]));
  if (const auto fit = least_squares(target, {columns[1]}); fit.remains <= allowed)
    return fmt::format("φ_x = {} φ_t, which {}", text((left ? 1 : -1) * fit.coefficients[0]),
                       fit.coefficients[0] > 0 ? "absorbs waves" : "feeds waves");
  if (const auto fit = least_squares(target, columns); fit.remains <= allowed)
    return fmt::format("φ_x = {} φ + {} φ_t", text((left ? 1 : -1) * fit.coefficients[0]),
                       text((left ? 1 : -1) * fit.coefficients[1]));
  return {};
}

}  // namespace delf
