// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

#include "tools/report/failure.hpp"
#include "tools/scene/scene.hpp"
#include "tools/workprecision/workprecision_outcome.hpp"

namespace delf {

/// Runs a scene with every scheme that the request names, over a ladder of resolutions, and times them in turn. Throws
/// BadScene for a request that cannot be met; a scheme that cannot be run is left out, with the reason. Checks
/// Interrupt::asked().
WorkPrecisionOutcome compare_schemes(const Scene&, const WorkPrecisionRequest&);

/// `delf workprecision`: error against run time. Leaves workprecision.json, .csv, the table by scheme as .md and .tex, and
/// a figure in `folder`, and tables on stdout.
ExitCode workprecision(const Scene&, const std::filesystem::path& folder);

}  // namespace delf
