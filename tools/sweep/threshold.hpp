// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "tools/sweep/run_pool.hpp"

namespace delf {

/// The crossing of a level by a number of a run.
struct Threshold {
  double low = 0, high = 0;  ///< it is between these values of the key
  double at_low = 0, at_high = 0, level = 0;
  std::vector<std::vector<std::string>> values;  ///< of all runs that were taken, with their rows
  std::vector<SweepRow> rows;
  bool found = false;  ///< not after Ctrl-C, nor without the number
};

/// Runs at both ends, then at three points between those of the first interval in which the number passes the level,
/// until the interval is as short as sweep.accuracy. Throws BadScene if both ends are on one side of the level, and
/// NumericalFailure for a run that leaves the number unknown. Nothing is found if no run can have it.
Threshold find_threshold(const SweepRequest&, const std::string& number, RunPool&);

}  // namespace delf
