// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/scene/scene.hpp"

namespace delf {

/// Values over time, as they are drawn.
struct Course {
  std::vector<double> times, values;
};

/// A run beside others of its scene.
struct ComparedRun {
  std::string words;    ///< of the keys that it differs in
  Course energy_error;  ///< of series.csv, relative to row 0
  Course error;  ///< in the maximum norm, of the rows of fields.h5 against the exact solution; empty if there is none
};

/// Reads the folder of a run. A run that left nothing has empty courses.
ComparedRun compared_run(const std::string& words, const Scene&, const std::filesystem::path& folder);

/// gnuplot commands for energies above errors, each over time, with one line a run; empty if nothing is to be shown.
std::string compared_runs_figure(const std::vector<ComparedRun>&, const std::filesystem::path& scratch);

}  // namespace delf
