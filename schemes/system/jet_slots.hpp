// SPDX-License-Identifier: MIT
#pragma once

#include "schemes/system/lattice_system.hpp"

namespace delf {

/// Throws BadInput if a density depends on a derivative that none of its stencils has in its jets, as φ_xx on a rectangle:
/// the term would be left out of the action.
void require_jet_slots(const LatticeSystem&);

}  // namespace delf
