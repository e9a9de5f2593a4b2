// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tools/workprecision/workprecision_outcome.hpp"

namespace delf {

/// The runs, among those with these indices, that no other beats in both error and seconds, from cheap to accurate:
/// along them seconds rise and errors fall, strictly. Runs whose error or time is not a number are never among them.
std::vector<std::size_t> lower_envelope(const std::vector<WorkPrecisionRun>&, std::span<const std::size_t> among);

/// The cheapest run with error ≤ accuracy, or nothing.
std::optional<std::size_t> cheapest(const std::vector<WorkPrecisionRun>&, std::span<const std::size_t> among,
                                    double accuracy);

/// Least squares slope of log error over log seconds along the more accurate half of a front (by orders of magnitude),
/// its flat end left out: runs less than twice as accurate as the second last, at the end, count as its floor if the
/// time for them went up more than the error went down. Not a number for less than two runs.
double slope_of(const std::vector<WorkPrecisionRun>&, std::span<const std::size_t> front);

/// The observed order in N of a scheme's runs: least squares of log error over log N at one h/k, that of which there are
/// most runs (of equals, with the least error), their floor and their coarse half left out as in slope_of. On a point,
/// where there is no N, over the number of steps. Not a number for less than two runs.
double order_of(const std::vector<WorkPrecisionRun>&, std::span<const std::size_t> runs);

/// Lines, envelopes and costs of the runs that an outcome holds, and how many are unsteady.
void compare(WorkPrecisionOutcome&, const std::vector<double>& accuracies);

}  // namespace delf
