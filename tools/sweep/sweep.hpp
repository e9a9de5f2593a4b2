// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "tools/report/failure.hpp"
#include "tools/scene/settings.hpp"

namespace delf {

/// `delf sweep`: runs the scene for every value of the keys that are given several, side by side in processes of their
/// own, and writes a row for each. Results go to `out`, or to results/NAME-sweep of the scene.
ExitCode sweep(const std::filesystem::path& scene, const std::vector<Setting>& on_command_line,
               const std::optional<std::string>& out);

}  // namespace delf
