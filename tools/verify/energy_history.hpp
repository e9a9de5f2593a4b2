// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "schemes/verify/check.hpp"

namespace delf {

/// The history of an energy at every row, a step of time apart: the largest change beside the first value, where it
/// begins, ends and goes. A map that keeps dq^dp swings about a modified energy; one that does not has a trend.
Measured measured_energy(const std::string& name, const std::vector<double>& values, double time_step,
                         const std::string& remark);

}  // namespace delf
