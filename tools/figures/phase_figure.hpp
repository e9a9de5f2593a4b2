// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>

#include "tools/figures/figures.hpp"

namespace delf {

/// Phase portraits of mechanics on a point: the momentum of each coordinate over the coordinate itself, of the first six.
/// Returns gnuplot commands; their data is written to `scratch`. Empty for a field in space, and where there are no momenta.
std::string phase_figure(const FigureSource&, const std::filesystem::path& scratch);

}  // namespace delf
