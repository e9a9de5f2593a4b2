// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "tools/results/result_folder.hpp"

namespace delf {

/// HTML of the theory and its equations, and of the scheme with its limits, as the scene of the folder says.
struct SolvedProblem {
  std::string what, how;
};
SolvedProblem solved_problem(const ResultFolder&);

}  // namespace delf
