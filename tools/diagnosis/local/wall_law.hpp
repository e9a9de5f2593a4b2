// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "tools/diagnosis/evidence.hpp"

namespace delf {

/// The law at an end of the lattice, by the value φ₋₁ of a site beyond it that the equation there asks for:
///
///     φ_x = (φ₁ − φ₋₁)/2k = α φ₀ + β φ_t,      Robin's for β = 0, absorbing for α = 0
///
/// "φ_x = 0.3 φ" if it holds in all rows to rounding; empty otherwise. Of one field and explicit equations that reach one
/// site. `left`: the end at site 0, else the one at site N − 1.
std::string wall_law(const Evidence&, bool left);

}  // namespace delf
