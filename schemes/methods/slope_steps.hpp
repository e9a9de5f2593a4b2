// SPDX-License-Identifier: MIT
#pragma once
#include <span>

#include "schemes/methods/method_registry.hpp"
#include "schemes/stepping/step_density.hpp"

namespace delf {

/// Steps that are shorter where a field is steep: over the cells of the newest row, of width δ,
///
///     σ = 1/√(1 + s²⟨φ_x²⟩),    G = s²⟨φ_x·(φ_x)_t⟩ / (1 + s²⟨φ_x²⟩),    φ_x = Δφ/δ,    (φ_x)_t = (Δφ_t − φ_x Δδ_t)/δ,
///
/// where ⟨ ⟩ is the mean over the cells, and φ_t, X_t are the rates of their sites. Cells of equal arclength have
/// δ = c/√(1 + α²φ_x²): for s = α steps are in proportion to the cells, as an explicit limit has them.
RowDensity density_of_slopes(const RowsInTime&, std::span<const double> rates, double strength);

}  // namespace delf
