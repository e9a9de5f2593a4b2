// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <vector>

#include "jets/tables/stencil_table.hpp"
#include "lattice/lattice.hpp"
#include "schemes/families/jet_family.hpp"

namespace delf {

/// The terms that the action of a density on a table needs at the natural walls of a lattice (wall_tables), as families
/// of the same density. None on a circle, on a point, and between fixed walls. Throws BadInput "lattice.stencil" where
/// a term is needed and φ_x = 0 is not the natural condition of the density.
std::vector<std::shared_ptr<const StencilFamily>> wall_families(const StencilTable&,
                                                                const std::shared_ptr<const BatchDensity>&,
                                                                const Lattice&);

}  // namespace delf
