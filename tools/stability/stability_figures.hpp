// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "tools/stability/stability_findings.hpp"

namespace delf {

/// Draws what the findings have data for into `folder`/figures, each as PNG and as SVG. Returns what is missing, in one
/// line, or an empty string.
std::string draw_stability(const StabilityFindings&, const std::string& scene, const FigureForm&,
                           const std::filesystem::path& folder);

/// The names of the figures, without ending; of the map there is one for each nine schemes.
std::vector<std::string> stability_figure_names(std::size_t schemes);

// Each writes its data into the scratch folder and gives the gnuplot commands, or nothing if there is nothing to show.
std::string stability_map_figure(const StabilityFindings&, const std::string& scene, std::size_t part,
                                 const std::filesystem::path& scratch);
std::string dispersion_figure(const StabilityFindings&, const std::string& scene, const std::filesystem::path& scratch);

inline constexpr std::size_t maps_in_a_figure = 9;

}  // namespace delf
