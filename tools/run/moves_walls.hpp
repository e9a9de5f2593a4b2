// SPDX-License-Identifier: MIT
#pragma once
#include <span>

#include "jets/symmetry.hpp"
#include "schemes/problem.hpp"

namespace delf {

/// True if ξ(y) = A y + b is not zero at a site that a wall holds, with y of a row [i·d + a], or at an end that is driven, where
/// y is of all times: what the symmetry conserves is taken up there, or comes from there.
bool moves_walls(const LinearSymmetry&, std::span<const double> row, const Problem&);

}  // namespace delf
