// SPDX-License-Identifier: MIT
#pragma once
#include "tools/report/failure.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

struct ComplexScene;

/// `delf plan`: the equations that a run of the scene would solve, how, its files, what it leaves out, and its cost by
/// trial steps. `latex`: the equations alone, for a paper.
ExitCode plan(const Scene&, bool latex);
/// The plan of a scene on a mesh, which has no equations for a paper.
ExitCode plan(const ComplexScene&, bool latex);
/// `delf plan --modified`: the modified Lagrangian up to an order in h and k, in place of all that.
ExitCode plan_modified(const Scene&, int order, bool latex);

}  // namespace delf
