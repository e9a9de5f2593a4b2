// SPDX-License-Identifier: MIT
#pragma once
#include <functional>

#include "schemes/simulation.hpp"
#include "tools/report/failure.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// The simulation of a scene. Throws BadScene with the line of the key that prevents it.
Simulation build(const Scene&, int winding);

/// Checks a scene whose command steps: throws BadScene, with the key, where no equation of a step determines some wave.
void require_determined(const Scene&, const Simulation&);

/// Runs `work`; a lattice that does not fit into memory becomes a SystemFailure that names the size requested.
ExitCode with_memory_for(const Scene&, const std::function<ExitCode()>& work);

}  // namespace delf
