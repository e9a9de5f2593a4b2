// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "tools/stability/corner.hpp"

namespace delf {

/// Kinds of corners, by the names that stability.corners knows.
const std::vector<std::string>& corner_groups();

/// The corners of a group for some schemes, in an order in which those of one name follow each other. Theories, lattices
/// and steps are the corners' own; the schemes' other keys (tolerance, iterations) stay as they are.
std::vector<Corner> corners(const std::string& group, const std::vector<NamedScheme>& schemes);

}  // namespace delf
