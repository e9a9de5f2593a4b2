// SPDX-License-Identifier: MIT
#pragma once
#include <chrono>
#include <string>

#include "tools/run/solution_error.hpp"

namespace delf {

/// The solution with which the runs of a scene are compared.
struct Reference {
  ComparedSolution solution;
  std::string words;
  double error = 0;  ///< how far it may be off
};

/// The exact solution; without one, the last row of the scheme of highest order, on lattices doubled until the row
/// changes no more, or the time is used up. The change by the last doubling is its error. Throws BadScene if no scheme
/// gives a row.
Reference find_reference(const Scene&, const WorkPrecisionRequest&, std::chrono::steady_clock::time_point until);

}  // namespace delf
