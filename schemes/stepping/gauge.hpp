// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "lattice/plan/solve_plan.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// The fields whose mean no equation of a slab determines, and whose own equations add up to nothing:
///
///     ∂E/∂y_c·(1, …, 1) = 0,    Σ_i E_ic = 0    at any rows
///
/// Such is the potential of the Korteweg–de Vries equation around a circle: with φ every φ + c(t) is a solution, and
/// u = φ_x is that of both. The mean of a row is then a gauge, which a step keeps.
std::vector<int> undetermined_means(const LatticeSystem&, const SolvePlan&);

/// "no equation determines the mean of a row, which is that of row 0", with their names if there are other fields.
std::string gauge_in_words(const LatticeSystem&, const std::vector<int>& undetermined);

/// The plan; without the unknown of site 0 of each such field and its equation there, which the others imply.
SolvePlan with_gauge(const LatticeSystem&, SolvePlan);

}  // namespace delf
