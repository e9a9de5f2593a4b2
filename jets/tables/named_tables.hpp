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
  std::vector<std::string> aliases = {};  ///< other names of its equations, on the lattices that it is for
  std::string words = {};                 ///< in a paper: "the symmetric rectangle"
  std::vector<std::string> sources = {};  ///< keys of tools/cite/references.bib

  /// It has no sites side by side: for lattice.space = point.
  bool is_for_point() const;
};

/// The list of all of them: a new stencil adds one line there.
const std::vector<NamedTable>& named_tables();

/// The name in named_tables() that a name or an alias stands for where space is a point, or where it is not: leapfrog is
/// the equations of one stencil on a lattice of space, and of another on a lattice of time. A name that is neither is
/// given back as it is.
std::string stencil_name(const std::string& name_or_alias, bool on_point);
/// All names of all stencils, the aliases last.
std::vector<std::string> stencil_names_and_aliases();

}  // namespace delf
