// SPDX-License-Identifier: MIT
#pragma once
#include "tools/scene/scene.hpp"
#include "tools/scene/values.hpp"

namespace delf {

// The parts of a scene that are read alike on a lattice and on a mesh.

/// The values of the parameters of the problem's theory and method, and those that the scene gives of others, which may run
/// in their place.
void read_parameters(const Values&, Problem&);
/// [output]: fields, figures and checkpoints; and every how many rows, some `usual` records unless the scene says.
void read_output(const Settings&, const Values&, int usual, Scene&);
/// Throws BadScene where run.until is above 0, and less than half a step: `steps` are none.
void require_a_step(const Settings&, const Values&, std::int64_t steps, double time_step);

}  // namespace delf
