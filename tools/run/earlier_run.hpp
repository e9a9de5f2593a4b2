// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>

namespace delf {

/// Removes what a run writes at its end: summary.json, section.csv, figures.
void remove_final_results(const std::filesystem::path& folder);

/// Removes all that an earlier run, on a lattice or on a mesh, has left under the names that the next may write. Throws
/// BadScene, and removes nothing, if the scene.ini there is not one of delf's.
void remove_earlier_run(const std::filesystem::path& folder);

/// " summary.json series.csv …": what a run has left there, for its report.
std::string files_of_run(const std::filesystem::path& folder);

}  // namespace delf
