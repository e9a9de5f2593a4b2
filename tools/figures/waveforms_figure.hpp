// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>

#include "tools/figures/figures.hpp"

namespace delf {

/// The field over space at up to six times, as small multiples on common axes.
/// Returns gnuplot commands; their data is written to `scratch`. Empty if there is nothing to show.
std::string waveforms_figure(const FigureSource&, const std::filesystem::path& scratch);

}  // namespace delf
