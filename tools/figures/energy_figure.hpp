// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>

#include "tools/figures/figures.hpp"

namespace delf {

/// The relative energy error over time; says so if it is all round-off.
/// Returns gnuplot commands; their data is written to `scratch`. Empty if there is nothing to show.
std::string energy_figure(const FigureSource&, const std::filesystem::path& scratch);

}  // namespace delf
