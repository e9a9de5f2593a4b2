// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>

#include "tools/figures/figures.hpp"

namespace delf {

/// The error against the exact solution over space and time, |φ − φ_exact|, of several fields the largest, as colours on a
/// logarithmic scale. Returns gnuplot commands; their data is written to `scratch`. Empty without an exact solution.
std::string error_figure(const FigureSource&, const std::filesystem::path& scratch);

}  // namespace delf
