// SPDX-License-Identifier: MIT
#pragma once
#include <chrono>
#include <string>

#include "tools/run/solution_error.hpp"

namespace delf {

/// What the runs of a scene are compared with.
struct Reference {
  ComparedSolution solution;
  std::string words;
  double error = 0;  ///< how far it may be off
};

/// The exact solution; without one, the last row of the scheme of highest order, on lattices doubled until that changes
/// it no more, or the time is used up. What the last doubling changed is its error. Throws BadScene where no scheme
/// gives any.
Reference find_reference(const Scene&, const WorkPrecisionRequest&, std::chrono::steady_clock::time_point until);

}  // namespace delf
