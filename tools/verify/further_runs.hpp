// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "schemes/verify/check.hpp"
#include "schemes/verify/reversal/time_reversal.hpp"
#include "tools/scene/scene.hpp"
#include "tools/verify/verdict.hpp"

namespace delf {

// Checks of a verification that need further runs.

/// Runs the scene at half of its steps in time and space up to the time of row rows − 1, and gives the balances their
/// orders; where it cannot be run so, they are left without, and the verdict says why.
void measure_orders(const Scene&, int winding, std::vector<Measured> balances, std::int64_t rows, Verdict&);

/// Forward from the first two rows, and back, by the simulations of a scene on a lattice or on a mesh; with the time T that
/// is given they are those of a run that begins there.
void reverse_time(const Scene&, const MakeSimulation&, const std::vector<std::vector<double>>& first_rows,
                  double tolerance, Verdict&);
/// Reverses the rows of a scene on a lattice.
void reverse_time(const Scene&, int winding, const std::vector<std::vector<double>>& first_rows, double tolerance,
                  Verdict&);

/// The steps of the scene's run. Where rows choose them only a run tells how many there are: that of this simulation, which
/// has started.
std::int64_t steps_of_run(const Scene&, Simulation&);

/// Site updates that either may cost: a second or two.
inline constexpr std::int64_t most_updates = 4000000;

}  // namespace delf
