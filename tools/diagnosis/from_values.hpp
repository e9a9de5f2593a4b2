// SPDX-License-Identifier: MIT
#pragma once
#include <optional>

#include "tools/diagnosis/evidence.hpp"

namespace delf {

/// The scheme of first order in time (traces between its steps) whose run from frame 0 alone, q⁻ = q⁺, gives the frames that
/// follow. Rows do not hold the traces, so that no other frame can be started from.
std::optional<Finding> find_from_values(const Evidence&);

}  // namespace delf
