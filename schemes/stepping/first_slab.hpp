// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/system/assembly.hpp"

namespace delf {

/// The unknowns of slab 0 besides the row itself: a plan may solve for a multiplier, or for the nodes of the cell
/// above, as soon as the row is there. Nothing for fields alone, whose equations at row 0 belong to slab 1. `slab` is the
/// plan's, at J = 0; `from_momenta`: the start is a row and its momenta, which close the equations that read earlier rows.
Assembly::Parts first_slab(const LatticeSystem&, const Assembly::Parts& slab, bool from_momenta);

}  // namespace delf
