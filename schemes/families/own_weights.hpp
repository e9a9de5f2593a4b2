// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "lattice/space/listed_stencils.hpp"

namespace delf {

/// The stencils of a table that lie anywhere, each with numbers of its own, such as its measure and the slopes of a cell:
/// TablePoint::Own says what they multiply. Stencils may share a set of them.
struct OwnWeights {
  std::shared_ptr<const ListedStencils> stencils;
  std::vector<std::vector<double>> numbers;  ///< [n][set]
  std::vector<std::int32_t> sets = {};       ///< [stencil]; empty: each has its own

  int set(int stencil) const { return sets.empty() ? stencil : sets[stencil]; }
};

}  // namespace delf
