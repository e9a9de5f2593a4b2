// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "tools/verify/verdict.hpp"

namespace delf {

/// Draws what a verdict has data for into `folder`/figures, in all formats; `scheme` is one line: stencil,
/// method, sites. Returns what is missing, in one line, or an empty string.
std::string draw_verdict(const Verdict&, const std::string& scene, const std::string& scheme, const FigureForm&,
                         const std::filesystem::path& folder);

/// The names of the figures, without ending.
std::vector<std::string> verdict_figure_names();

/// The data that a figure of a verdict is drawn from.
struct VerdictSource {
  const Verdict& verdict;
  std::string scene, scheme;
};

// Each writes its data into the scratch folder and gives the gnuplot commands, or nothing if there is nothing to show.
std::string residual_map_figure(const VerdictSource&, const std::filesystem::path& scratch);
std::string severity_map_figure(const VerdictSource&, const std::filesystem::path& scratch);
std::string own_energy_figure(const VerdictSource&, const std::filesystem::path& scratch);
std::string residual_region_figure(const VerdictSource&, const std::filesystem::path& scratch);
std::string worst_region_figure(const VerdictSource&, const std::filesystem::path& scratch);
std::string time_reversal_figure(const VerdictSource&, const std::filesystem::path& scratch);

/// Values below round-off, 0 above all, are drawn here on a logarithmic axis.
inline constexpr double drawn_zero = 1e-18;
/// A value on a logarithmic axis.
double drawn_logarithmic(double value);
/// A title with a quieter line below it, which `more` ends.
std::string verdict_title(const std::string& title, const std::string& subtitle, const std::string& more = "");

}  // namespace delf
