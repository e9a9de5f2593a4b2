// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "tools/stability/stress_case.hpp"

namespace delf {

/// Kinds of stress cases, by the names that stability.corners knows.
const std::vector<std::string>& stress_groups();

/// The stress cases of a group for some schemes, in an order in which those of one name follow each other. Theories,
/// lattices and steps are the cases' own; the schemes' other keys (tolerance, iterations) stay as they are.
std::vector<StressCase> stress_cases(const std::string& group, const std::vector<NamedScheme>& schemes);

}  // namespace delf
