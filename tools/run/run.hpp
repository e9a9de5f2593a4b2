// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

#include "tools/failure.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// `delf run`: steps a scene and leaves scene.ini, series.csv, summary.json, fields.h5 and figures in `folder`, and a
/// report on stdout. Whatever stops it, what it has by then is written first.
ExitCode run(const Scene&, const std::filesystem::path& folder);

}  // namespace delf
