// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "schemes/system/lattice_system.hpp"
#include "tools/outcome/outcome.hpp"

namespace delf {

/// Throws BadScene for a scene with output.estimate whose rows runs at other steps do not have.
void require_estimable(const Scene&, const LatticeSystem&);

/// `last_row` and the measures of `outcome` are those of the scene's own run. A scene that cannot be run at half its steps
/// has an estimate that says so.
ErrorEstimate estimate_error(const Scene&, const Outcome&, const std::vector<double>& last_row);

}  // namespace delf
