// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "tools/scene/settings.hpp"

namespace delf {

/// Settings that are read already, or that no file holds; `file` is what messages call them. Throws BadScene for unknown
/// keys.
Settings made_settings(const std::filesystem::path& file, const std::vector<Setting>& in_file,
                       const std::vector<Setting>& on_command_line);

}  // namespace delf
