// SPDX-License-Identifier: MIT
#include "schemes/methods/slope_steps.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "schemes/theories/field_theory.hpp"

namespace delf {

RowDensity density_of_slopes(const RowsInTime& rows, std::span<const double> rates, double strength) {
  const LatticeSystem& system = rows.system;
  const auto& all = system.all_components();
  const int C = system.components(), d = rows.theory.components(), cells = system.lattice().cells();
  const int X = static_cast<int>(std::ranges::find(all, true, &Component::position) - all.begin());
  // y_{i+1} − y_i of a component and of its rates; sites that stand still are k apart
  const auto rise = [&](int i, int c) { return rows.rows(rows.newest, i + 1, c) - rows.rows(rows.newest, i, c); };
  const auto rise_of_rates = [&](int i, int c) {
    const int next = system.lattice().home(i + 1);
    return rates[next * C + c] - rates[i * C + c];
  };
  double square = 0, product = 0;  // Σ φ_x², Σ φ_x (φ_x)_t
  for (int i = 0; i < cells; ++i) {
    const double width = X < C ? rise(i, X) : system.lattice().space_step(), widening = X < C ? rise_of_rates(i, X) : 0;
    for (int a = 0; a < d; ++a) {
      const int c = system.field_component(a);
      const double slope = rise(i, c) / width;
      square += slope * slope;
      product += slope * (rise_of_rates(i, c) - slope * widening) / width;
    }
  }
  const double s2 = strength * strength, of_path = 1 + s2 * square / cells;
  return {std::sqrt(of_path), s2 * product / cells / of_path};
}

}  // namespace delf
