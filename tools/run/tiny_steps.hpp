// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "tools/scene/scene.hpp"

namespace delf {

/// Steps that the field chooses and that are a thousand times as short as lattice.time_step: a run of these would not end.
/// `speed` is what they depend on, as <phi_t^2>. Throws BadScene.
void refuse_tiny_steps(const Scene&, double first_step, const std::string& speed);

}  // namespace delf
