// SPDX-License-Identifier: MIT
#pragma once
#include "tools/failure.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// `delf plan`: what a run of the scene would solve, how, what it would write, what it leaves out, and what it would
/// cost, by trial steps.
ExitCode plan(const Scene&);

}  // namespace delf
