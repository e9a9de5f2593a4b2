// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "tools/diagnosis/evidence.hpp"

namespace delf {

/// The explanation of rows that do not solve the equations of a scene; or, for rows that do, whose they are.
struct Diagnosis {
  std::vector<Finding> findings;
};
/// The system of the evidence must have fields at the vertices and nothing else.
Diagnosis diagnose(Evidence);

}  // namespace delf
