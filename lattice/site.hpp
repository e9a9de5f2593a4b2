// SPDX-License-Identifier: MIT
#pragma once
#include <compare>

namespace delf {

/// A site of spacetime, or an offset between two. The paper writes (i, j) = (space, time); this is the one place where
/// an order is chosen: time first. A lattice repeats a unit cell of one or more sites: `node` numbers them, 0 is
/// the vertex of the cell and the only one of most lattices; the nodes inside an element have the others.
struct Site {
  int time = 0, space = 0, node = 0;

  friend constexpr auto operator<=>(const Site&, const Site&) = default;
  friend constexpr Site operator+(Site a, Site b) { return {a.time + b.time, a.space + b.space, a.node + b.node}; }
  friend constexpr Site operator-(Site a, Site b) { return {a.time - b.time, a.space - b.space, a.node - b.node}; }
};

}  // namespace delf
