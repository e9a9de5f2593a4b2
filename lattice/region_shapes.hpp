// SPDX-License-Identifier: MIT
#pragma once
#include <random>
#include <string>
#include <vector>

#include "lattice/region.hpp"

namespace delf {

/// Kinds of regions. Each is the union of the stencils that touch a set of centres of that form, so that every
/// centre is interior and the region is regular.
enum class RegionKind {
  box,        ///< "rectangle", which is the name of a shape already
  staircase,  ///< rows that begin further and further along
  hole,       ///< a rectangle with sites inside that are not in U
  wall,       ///< a rectangle that ends at a wall of the interval
  slab,       ///< all of space
  random      ///< connected, grown site by site
};
const char* to_string(RegionKind);
const std::vector<RegionKind>& region_kinds();

/// The range of places for centres.
struct RegionFrame {
  Range rows;                           ///< of the centres
  int reach_time = 1, reach_space = 1;  ///< how far apart two sites of one equation are
  int nodes = 1;                        ///< of the unit cell
  int most_columns = 48;                ///< of regions that do not hold all of space
};

/// Centres of a region of this kind, drawn at random; empty where there is no room for one: a hole in a lattice of few
/// sites, a wall on a circle, anything but a slab on a point.
std::vector<Site> draw_centres(RegionKind, const Lattice&, const RegionFrame&, std::mt19937_64&);

/// Up to `count` sites of the interior of a region, grown at random from one of them by stencils that hold both: on any
/// space, where nothing need repeat.
std::vector<Site> draw_connected(const Region& within, int count, std::mt19937_64&);

/// The union of all stencils that touch one of the centres.
Region region_around(const Stencils&, const std::vector<Site>& centres, Region::IsData = {});
inline Region region_around(const Lattice& lattice, const std::vector<StencilPattern>& families,
                            const std::vector<Site>& centres) {
  return region_around(Stencils(lattice, families), centres);
}

}  // namespace delf
