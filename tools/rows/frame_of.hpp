// SPDX-License-Identifier: MIT
#pragma once
#include "tools/scene/scene.hpp"

namespace delf {

/// The frame of a file that is row `row` of the run, which goes backward through the file where its steps do.
inline int frame_of(const Scene& scene, int row) {
  return scene.initial_frame + (scene.problem.time_step < 0 ? -row : row);
}

}  // namespace delf
