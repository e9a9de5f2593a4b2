// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "tools/scene/scene.hpp"

namespace delf {

/// The names of the measures that settings give, in their order.
std::vector<std::string> measure_names(const Settings&);

/// measure.NAME
std::string key_of_measure(const std::string& name);

/// Throws BadScene for a name that is none, or a function, or one of summary.json, which tables of sweeps have beside it.
void check_measure_names(const Scene&);

}  // namespace delf
