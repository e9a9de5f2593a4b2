// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <string>
#include <vector>

#include "tools/complex/complex_scene.hpp"
#include "tools/warnings/energy_warnings.hpp"

namespace delf {

/// Why a run of rows or cells that ended well may be wrong all the same, by the rules of lattices (see Warnings): its
/// energy, its error, and a field that leaves the range of its data. Not a number for an energy of the start: that of row 0.
std::vector<std::string> warnings_of_rows(const ComplexScene&, const Outcome&, double energy_of_start,
                                          const Trace& energy_errors, std::span<const double> last_row);

}  // namespace delf
