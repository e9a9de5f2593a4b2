// SPDX-License-Identifier: MIT
#pragma once
#include <memory>

#include "jets/batch_density.hpp"
#include "jets/tables/stencil_table.hpp"

namespace delf {

/// A density and the table that its jets come from.
struct DensityOnTable {
  StencilTable table;
  std::shared_ptr<const BatchDensity> density;
};

}  // namespace delf
