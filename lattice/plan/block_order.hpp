// SPDX-License-Identifier: MIT
#pragma once
#include <utility>
#include <vector>

namespace delf {

/// The strongly connected components of unknowns 0 … n−1, in an order in which they can be solved one after the other.
/// An edge (u, v): the equation that determines u contains v.
std::vector<std::vector<int>> blocks_in_order(int n, const std::vector<std::pair<int, int>>& edges);

}  // namespace delf
