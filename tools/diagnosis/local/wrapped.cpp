// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lattice/index.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/diagnosis/findings.hpp"
#include "tools/diagnosis/own_equations.hpp"
#include "tools/diagnosis/unwrap.hpp"

namespace delf {

constexpr double circle = 2 * std::numbers::pi;

void unwrap_after(const std::vector<double>& before, std::vector<double>& row) {
  for (std::size_t n = 0; n < row.size(); ++n) row[n] -= circle * std::round((row[n] - before[n]) / circle);
}

void unwrap_along(std::vector<double>& row, int components) {
  const std::size_t C = components;
  for (std::size_t n = C; n < row.size(); ++n) row[n] -= circle * std::round((row[n] - row[n - C]) / circle);
}

void unwrap_to(std::span<const double> first, std::vector<double>& row) {
  const std::size_t C = first.size();
  std::vector<double> by;
  for (std::size_t c = 0; c < C; ++c) by.push_back(circle * std::round((first[c] - row[c]) / circle));
  for (std::size_t n = 0; n < row.size(); ++n) row[n] += by[n % C];
}

double monodromy_of_row(const std::vector<double>& row, int components) {
  const std::size_t last = row.size() - at(components);
  return circle * std::round((row[last] - row[0]) / circle);
}

std::optional<Finding> find_wrapped(const Evidence& e) {
  if (!find_theory(e.problem.theory).angle) return std::nullopt;
  const LatticeSystem& system = e.system;
  const std::int64_t reach = std::max(1, system.height());
  const auto& failing = e.failed.rows();
  constexpr std::size_t tried = 12;
  int jumps = 0;
  for (std::size_t n = 0; n < tried && n < failing.size(); ++n) {
    const std::int64_t row = failing[failing.size() * n / std::min(tried, failing.size())];
    std::vector<std::vector<double>> rows;
    bool jump = false;
    for (std::int64_t j = row - reach; j <= row + reach; ++j) {
      rows.push_back(e.row(j));
      std::vector<double>& now = rows.back();
      const std::vector<double> given = now;
      if (rows.size() > 1) unwrap_after(rows[rows.size() - 2], now);
      else unwrap_along(now, system.components());
      jump = jump || now != given;
    }
    if (!jump) continue;  // fails for another reason
    ++jumps;
    const double monodromy = system.lattice().is_circle() ? monodromy_of_row(rows.front(), system.components()) : 0;
    if (!(worst_equation(system, rows, row - reach, row, monodromy) <= e.tolerance)) return std::nullopt;
  }
  if (jumps == 0) return std::nullopt;
  return Finding{
      "wrapped",
      "The values are reduced modulo 2π: with the jumps by 2π taken back the equations hold. Use verify.unwrap = "
      "on, which follows every value from row to row, or theory.fibre = S1."};
}

}  // namespace delf
