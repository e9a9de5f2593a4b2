// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "tools/report/failure.hpp"
#include "tools/scene/settings.hpp"

namespace delf {

enum class SweepKind { sweep, compare };

/// `delf sweep`: runs the scene for every value of the keys that are given several, in processes of their own, and writes
/// a row for each. Results go to `out`, or to results/NAME-sweep of the scene. `delf compare` does the same, with the
/// runs side by side in one figure over time, into results/NAME-compare.
ExitCode sweep(const std::filesystem::path& scene, const std::vector<Setting>& on_command_line,
               const std::optional<std::string>& out, SweepKind = SweepKind::sweep);

}  // namespace delf
