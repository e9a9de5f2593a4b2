// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <vector>

#include "tools/report/failure.hpp"
#include "tools/scene/settings.hpp"

namespace delf {

/// `delf resume`: goes on with the run of a folder from its checkpoint. The rows, the series and the summary are those that
/// the run would have given without a break, to the bit. Keys that change no row may be given anew. Throws BadScene for
/// what cannot be resumed.
ExitCode resume(const std::filesystem::path& folder, const std::vector<Setting>& on_command_line);

}  // namespace delf
