// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <vector>

#include "tools/workprecision/resolution_search.hpp"

namespace delf {

/// The number of times that each run is timed, so that all of them take at most `seconds`: `repeats` times, or less for
/// those that take longest, but once at least.
std::vector<int> shared_repeats(const std::vector<double>& cost_of_each, int repeats, double seconds);

/// Times the runs, round after round, each round in an order of its own, so that other load on the machine affects all
/// of them alike. An entry is built when its turn comes, untimed, and none is kept: memory is that of one. The clock counts
/// steps. Ends after Ctrl-C and at `until`, within a run too; a run that was never timed keeps the seconds of its first
/// time. `at` is called after each.
void time_in_turn(std::vector<TriedRun>&, const std::vector<WorkPrecisionEntry>&, const std::vector<int>& repeats,
                  std::uint64_t seed, const StepClock&, std::chrono::steady_clock::time_point until,
                  const std::function<void()>& at);

}  // namespace delf
