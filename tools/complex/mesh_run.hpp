// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

#include "tools/complex/complex_scene.hpp"
#include "tools/report/failure.hpp"
#include "tools/run/run.hpp"

namespace delf {

/// `delf run` of a scene on a mesh. With `resumed`, the run of that folder goes on from there.
ExitCode run(const ComplexScene&, const std::filesystem::path& folder, Resumed resumed = {});

}  // namespace delf
