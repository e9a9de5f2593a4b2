// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lattice/complex/complex.hpp"
#include "lattice/complex/matching.hpp"

namespace delf {

/// How the unknowns of a complex are found, by graph algorithms alone: a perfect matching of equations and unknowns, the
/// strongly connected components of what then depends on what, and their topological order. The blocks are the same for
/// every perfect matching. Blocks of a level do not depend on each other.
struct ComplexPlan {
  /// By blocks, in an order in which they can be solved one after the other; equations[n] is matched with unknowns[n].
  std::vector<std::int32_t> unknowns, equations;
  std::vector<std::int32_t> first{0};  ///< of each block, and the end
  std::vector<std::int32_t> level;     ///< of each block; blocks are sorted by it
  int levels = 0;
  int largest = 0;  ///< unknowns of a block
  int widest = 0;   ///< blocks of a level

  /// Of each of so many sites the level that finds its value; −1 where that is data.
  std::vector<std::int32_t> level_of_sites(int sites) const;
  int blocks() const { return static_cast<int>(first.size()) - 1; }
  /// "2 levels, 162 unknowns, each in a block of its own" or "one block of 961 unknowns"
  std::string describe() const;
};

/// Which unknown sites each equation contains, both in the order of sites.
struct ComplexIncidence {
  std::vector<std::int32_t> equations, unknowns;  ///< sites
  Incidence contains;
};
ComplexIncidence incidence_of(const Complex&, const Touching&);

/// Throws BadInput "lattice.mesh" that names sites, if some equations determine too much, or some unknowns are not
/// determined.
ComplexPlan make_plan(const Complex&, const Touching&);

}  // namespace delf
