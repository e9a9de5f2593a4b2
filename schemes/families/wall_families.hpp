// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <vector>

#include "jets/tables/stencil_table.hpp"
#include "lattice/lattice.hpp"
#include "schemes/families/jet_family.hpp"

namespace delf {

/// φ_x at clamped walls, of each component of the field; none: 0.
struct WallSlopes {
  std::vector<double> left, right;
};

/// The terms that the action of a density on a table needs at the walls of a lattice, as families of the same density. None on a
/// circle and on a point.
///
/// A stencil of two columns needs those of wall_tables at natural walls. Throws BadInput "lattice.stencil" where a term is
/// needed and φ_x = 0 is not the natural condition of the density.
///
/// Stencils of three columns stand for the cell around their middle, so that half a cell is left out at either wall: half the
/// stencil there, with the mirror image of the field beyond (mirror_table), makes it up. Walls of
/// densities with φ_xx are the ends of a beam:
///
///     clamped    φ and φ_x = s are kept     y₋₁ = y₁ − 2ks      even
///     fixed      φ is kept: hinged          y₋₁ = 2y₀ − y₁      odd: φ_xx = 0, the natural condition
///     natural    nothing is kept: free      y₋₁ = 2y₀ − y₁      odd, and y₀ is varied
///
/// Throws BadInput "boundary.left" or "boundary.right" where φ_xx = 0 is needed and is not the density's natural condition, and
/// where a density without φ_xx is clamped.
std::vector<std::shared_ptr<const StencilFamily>> wall_families(const StencilTable&,
                                                                const std::shared_ptr<const BatchDensity>&,
                                                                const Lattice&, const WallSlopes& = {});

/// Between walls the stencils of a table and its terms there make up the action of the whole interval: it has two columns, or
/// three around their middle.
bool fits_between_walls(const StencilTable&);

}  // namespace delf
