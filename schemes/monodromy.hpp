// SPDX-License-Identifier: MIT
#pragma once
#include <numbers>

#include "schemes/problem.hpp"

namespace delf {

/// The gain of the fields around a circle beside 2π·winding, in their own units: a parameter of problem and state.
inline constexpr auto gain_key = "boundary.gain";

inline double gain_of(const ParameterValues& values) { return values.maybe<double>(gain_key).value_or(0); }

/// φ(x + L) − φ(x)
inline double monodromy_of(const Problem& p) { return 2 * std::numbers::pi * p.winding + gain_of(p.parameters); }

}  // namespace delf
