// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "lattice/plan/solve_plan.hpp"
#include "schemes/stepping/stepper.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// Describes in one line how a step is solved.
std::string solve_in_words(const SolvePlan&, const Stepper&);

/// The text of `delf plan`: stencils, who determines what, the linearised field equation as a table of coefficients
/// over its sites, the solver, the memory of a run whose rows are checked, `monitor_bytes` of it for monitors, and
/// what is left out.
std::string plan_report(const LatticeSystem&, const SolvePlan&, const Stepper&, std::size_t monitor_bytes);

}  // namespace delf
