// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <memory>

#include "tools/files/checkpoint_file.hpp"
#include "tools/report/failure.hpp"
#include "tools/run/checkpoints.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// A checkpoint of which the head has been read.
struct Resumed {
  std::unique_ptr<CheckpointReader> state;
  CheckpointHead head;
};

/// `delf run`: steps a scene and leaves scene.ini, series.csv, summary.json, fields.h5 and figures in `folder`, and a
/// report on stdout. However it ends, the results so far are written first.
/// With `resumed`, the run of that folder goes on from there.
ExitCode run(const Scene&, const std::filesystem::path& folder, Resumed resumed = {});

}  // namespace delf
