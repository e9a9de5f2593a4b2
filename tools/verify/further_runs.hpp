// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "schemes/verify/check.hpp"
#include "tools/scene/scene.hpp"
#include "tools/verify/verdict.hpp"

namespace delf {

// Checks of a verification that need further runs.

/// Runs the scene at half of its steps in time and space up to the time of row rows − 1, and gives the balances their
/// orders; where it cannot be run so, they are left without, and the verdict says why.
void measure_orders(const Scene&, int winding, std::vector<Measured> balances, std::int64_t rows, Verdict&);

/// Forward from the scene's first two rows, and back.
void reverse_time(const Scene&, int winding, const std::vector<std::vector<double>>& first_rows, double tolerance,
                  Verdict&);

/// Site updates that either may cost: a second or two.
inline constexpr std::int64_t most_updates = 4000000;

}  // namespace delf
