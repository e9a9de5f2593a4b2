// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "schemes/system/lattice_system.hpp"

namespace delf {

/// The sum of terms in the equations of a system where the fields reach `largest`: max_c Σ_a |∂E_c/∂y_a| · largest, of
/// their constant part.
double scale_of_terms(const LatticeSystem&, double largest);

/// The largest absolute value.
double largest_of(const std::vector<std::vector<double>>& rows);

/// The largest |E| of row `row`, relative to scale_of_terms of these rows, at the sites first … last; fixed walls have no equation.
/// rows[n] is row first_row + n.
double worst_equation(const LatticeSystem&, const std::vector<std::vector<double>>& rows, std::int64_t first_row,
                      std::int64_t row, double monodromy, int first, int last);
/// The largest residual of any site.
double worst_equation(const LatticeSystem&, const std::vector<std::vector<double>>& rows, std::int64_t first_row,
                      std::int64_t row, double monodromy);

}  // namespace delf
