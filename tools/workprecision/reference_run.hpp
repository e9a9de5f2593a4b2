// SPDX-License-Identifier: MIT
#pragma once
#include <chrono>
#include <optional>
#include <string>

#include "tools/compare/solution_error.hpp"
#include "tools/workprecision/entry.hpp"

namespace delf {

/// The solution with which the runs of a scene are compared.
struct Reference {
  ComparedSolution solution;
  std::string words;
  double error = 0;  ///< how far it may be off
};

/// The exact solution; without one, the last row of the scheme of highest order, on lattices doubled until the row
/// changes no more, or `until` has come. The change by the last doubling is its error. Nothing after Ctrl-C. Throws
/// BadScene if no scheme gives a row, or none before the limit.
std::optional<Reference> find_reference(const Scene&, const WorkPrecisionRequest&,
                                        std::chrono::steady_clock::time_point until, const RunLimit&);

}  // namespace delf
