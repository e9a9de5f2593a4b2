// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "schemes/system/lattice_system.hpp"

namespace delf {

/// The part of a density's text that has no value on the last rows, or on the row that they lead to, and the jet there:
/// "log(phi) has no value at site 3 near t = 1.2, where phi = -0.1". Empty if it has values
/// everywhere, and for densities that are compiled.
std::string without_value(const LatticeSystem&, Window last_rows);

}  // namespace delf
