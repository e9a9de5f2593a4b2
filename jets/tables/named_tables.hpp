// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "jets/tables/stencil_table.hpp"

namespace delf {

/// A stencil that a scene can name by lattice.stencil.
struct NamedTable {
  std::string name, description;
  StencilTable table;
};

/// The list of all of them: a new stencil adds one line there.
const std::vector<NamedTable>& named_tables();

}  // namespace delf
