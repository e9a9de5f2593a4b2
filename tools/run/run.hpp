// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

#include "tools/failure.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// `delf run`: steps a scene and leaves scene.ini, series.csv, summary.json, fields.h5 and figures in `folder`, and a
/// report on stdout. However it ends, the results so far are written first.
ExitCode run(const Scene&, const std::filesystem::path& folder);

}  // namespace delf
