// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "schemes/simulation.hpp"

namespace delf {

/// The key that chooses if a processor makes a kernel's first rows of φ and φ_t, and is undone where rows are recorded.
inline constexpr auto processor_key = "scheme.processor";

/// The kernel of a problem without its processor: rows start from φ and φ_t as they are.
inline Problem kernel_alone(Problem problem) {
  problem.parameters[processor_key] = std::string("off");
  return problem;
}

}  // namespace delf
