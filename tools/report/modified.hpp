// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "jets/expressions/modified/modified_lagrangian.hpp"
#include "schemes/modified_energy.hpp"
#include "schemes/simulation.hpp"

namespace delf {

/// The modified Lagrangian of a problem's scheme. Throws BadInput where it has none, or none that is found.
ModifiedLagrangian modified_lagrangian(const Problem&, const Simulation&, int order);

/// Its energy and momentum over rows, for output.modified. `gain`: φ(x + L) − φ(x).
ModifiedEnergy modified_energy(const Problem&, const Simulation&, int order, double gain);

/// It as text, for `delf plan --modified`: the terms of each h^a k^b on lines of their own.
std::string modified_in_words(ModifiedLagrangian&, const SymbolicDensity&);
/// It as LaTeX, a displayed formula.
std::string modified_in_latex(ModifiedLagrangian&, const SymbolicDensity&);

}  // namespace delf
