// SPDX-License-Identifier: MIT
#include "tools/diagnosis/own_equations.hpp"

#include <algorithm>
#include <cmath>

namespace delf {

double scale_of_terms(const LatticeSystem& system, double largest) {
  double most = 0;
  const Site middle{0, system.lattice().sites() / 2};
  for (int c = 0; c < system.components(); ++c) {
    double sum = 0;
    for (const Coefficient& a : system.linearised(middle, c)) sum += std::abs(a.value);
    most = std::max(most, sum);
  }
  return most * largest;
}

double largest_of(const std::vector<std::vector<double>>& rows) {
  double most = 0;
  for (const auto& row : rows)
    for (const double y : row) most = std::max(most, std::abs(y));
  return most;
}

double worst_equation(const LatticeSystem& system, const std::vector<std::vector<double>>& rows, std::int64_t first_row,
                      std::int64_t row, double monodromy, int first, int last) {
  std::vector<LatticeSystem::Value> values;
  system.equations(system.window(first_row, rows, monodromy), row, values);
  double worst = 0;
  for (int i = first; i <= last; ++i)
    for (int c = 0; c < system.components(); ++c)
      if (!system.is_held(i, c)) {
        const double E = std::abs(values[i * system.components() + c].sum);
        if (!(E <= worst)) worst = E;
      }
  return worst == 0 ? 0 : worst / scale_of_terms(system, largest_of(rows));
}

double worst_equation(const LatticeSystem& system, const std::vector<std::vector<double>>& rows, std::int64_t first_row,
                      std::int64_t row, double monodromy) {
  return worst_equation(system, rows, first_row, row, monodromy, 0, system.lattice().sites() - 1);
}

}  // namespace delf
