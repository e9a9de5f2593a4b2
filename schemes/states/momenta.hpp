// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "schemes/states/state_registry.hpp"

namespace delf::initial {

/// "0.25, 0.125": as many numbers as the theory has fields; zeros if the key is not given.
std::vector<double> numbers(const StateBuild&, const std::string& key, int count);
/// The rates at q of the momenta initial.p. Throws BadInput where there are none: `rates` is the key to give in their place.
std::vector<double> velocities_of_momenta(const StateBuild&, const std::vector<double>& q, const std::string& rates);

}  // namespace delf::initial
