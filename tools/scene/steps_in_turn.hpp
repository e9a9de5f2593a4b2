// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "tools/scene/settings.hpp"

namespace delf {

/// The steps of lattice.time_steps: "0.1, 0.05", or those of a file of that name, beside the scene or here, where lines
/// and commas separate them and # begins a comment. Throws BadScene, which names the line of the file.
std::vector<double> steps_in_turn(const Settings&, const std::string& text);

}  // namespace delf
