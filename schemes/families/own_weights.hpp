// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <vector>

#include "lattice/space/listed_stencils.hpp"

namespace delf {

/// The stencils of a table that lie anywhere, each with numbers of its own, such as its measure and the slopes of a cell:
/// TablePoint::Own says what they multiply.
struct OwnWeights {
  std::shared_ptr<const ListedStencils> stencils;
  std::vector<std::vector<double>> numbers;  ///< [n][stencil]
};

}  // namespace delf
