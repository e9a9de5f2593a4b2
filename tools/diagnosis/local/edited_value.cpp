// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/diagnosis/findings.hpp"
#include "tools/diagnosis/own_equations.hpp"

namespace delf {

// A value y that solves the equations of its neighbourhood: Gauss–Newton for min Σ E(y)², by differences.
std::optional<Finding> find_edited_value(const Evidence& e) {
  const LatticeSystem& system = e.system;
  const std::int64_t reach = std::max(1, system.height());
  const auto& failing = e.failed.rows();
  const auto sites = e.failed.sites();
  const bool point = system.lattice().space() == Space::point;
  if (failing.empty() || failing.back() - failing.front() > 2 * reach) return std::nullopt;
  if (!point && (sites.back() - sites.front() > 2 * system.width() || e.failed.rows_tried() < 4)) return std::nullopt;
  const std::int64_t row = (failing.front() + failing.back()) / 2;
  const int C = system.components(), first = sites.front(), last = sites.back();
  const std::int64_t from = row - 2 * reach, to = row + 2 * reach;
  if (from < 0 || to >= e.rows) return std::nullopt;
  std::vector<std::vector<double>> rows;
  for (std::int64_t r = from; r <= to; ++r) rows.push_back(e.row(r));

  std::vector<LatticeSystem::Value> found;
  const auto residuals = [&] {
    std::vector<double> all;
    for (std::int64_t j = row - reach; j <= row + reach; ++j) {
      system.equations(system.window(from, rows, e.monodromy), j, found);
      for (int i = first; i <= last; ++i)
        for (int c = 0; c < C; ++c)
          if (!system.is_held(i, c)) all.push_back(found[i * C + c].sum);
    }
    return all;
  };
  for (int c = 0; c < C; ++c) {
    double& y = rows[row - from][(first + last) / 2 * C + c];
    const double there = y, size = std::max(1e-6, 1e-6 * std::abs(y));
    for (int n = 0; n < 8; ++n) {
      const auto E = residuals();
      y += size;
      const auto beside = residuals();
      y -= size;
      double along = 0, square = 0;
      for (std::size_t m = 0; m < E.size(); ++m) {
        const double slope = (beside[m] - E[m]) / size;
        along += slope * E[m], square += slope * slope;
      }
      if (!(square > 0)) break;
      y -= along / square;
    }
    double worst = 0;
    for (std::int64_t j = row - reach; j <= row + reach; ++j)
      worst = std::max(worst, worst_equation(system, rows, from, j, e.monodromy));
    // Differences leave more than rounding.
    if (worst <= 10 * e.tolerance && y != there)
      return Finding{
          "edited-value",
          fmt::format("One value was changed: row {}{}, is {:.17g}, and {:.12g} solves all equations around it.", row,
                      point ? "" : fmt::format(", site {}", (first + last) / 2), there, y)};
    y = there;
  }
  return std::nullopt;
}

}  // namespace delf
