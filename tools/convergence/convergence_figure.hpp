// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "tools/compare/convergence_table.hpp"

namespace delf {

/// Errors against N, or against steps in a unit of time where there is no space, both axes logarithmic, with lines of these
/// orders below them: Tyranowski–Desbrun, Fig. 11. Returns what is missing, in one line, or an empty string.
std::string draw_convergence(const Scene&, const std::string& label, const ConvergenceTable&,
                             const std::vector<double>& orders, const std::filesystem::path& folder);

/// Its name, without ending.
inline constexpr auto convergence_figure = "convergence";

}  // namespace delf
