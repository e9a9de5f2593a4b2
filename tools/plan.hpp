// SPDX-License-Identifier: MIT
#pragma once
#include "tools/failure.hpp"
#include "tools/scene.hpp"

namespace delf {

/// `delf plan`: what a run of the scene would solve, how, at what cost, what it would write, and what it leaves out.
ExitCode plan(const Scene&);

}  // namespace delf
