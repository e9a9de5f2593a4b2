// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "schemes/simulation.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// Says in words that waves on the theory's vacuum grow more than tenfold in so many steps, by linear theory. Nothing
/// where they not, or where there is no such theory.
std::optional<std::string> beyond_linear_limit(const Scene&, const Simulation&, std::int64_t steps);

}  // namespace delf
