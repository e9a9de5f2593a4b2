// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/simulation.hpp"
#include "tools/figures/figures.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// The waves that a scene's lattice has about its vacuum, by its symbol, and those of its field equation: for a spectrum
/// without its rows. None where linear theory has no symbol, or the field no vacuum.
DrawnSpectrum waves_of(const Scene&, const Simulation&);

}  // namespace delf
