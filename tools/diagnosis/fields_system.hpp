// SPDX-License-Identifier: MIT
#pragma once
#include <optional>

#include "schemes/simulation.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// The equations of a problem whose components are fields at the vertices and nothing else. Nothing for others, and for
/// what cannot be built.
std::optional<LatticeSystem> fields_system(const Problem&);

}  // namespace delf
