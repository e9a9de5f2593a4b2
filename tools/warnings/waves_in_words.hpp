// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "schemes/simulation.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// The verdict of linear theory on the scheme, with these steps, about a constant field: a line for each wave. Empty where
/// there is no such theory.
std::string waves_in_words(const Scene&, const Simulation&);

}  // namespace delf
