// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

#include "tools/report/failure.hpp"
#include "tools/scene/scene.hpp"
#include "tools/stability/stability_findings.hpp"
#include "tools/stability/stability_request.hpp"

namespace delf {

/// Limits by theory and by running, stress cases, maps and dispersion, as requested. Ends early when interrupted.
StabilityFindings find_stability(const StabilityRequest&, const Problem& base);

/// `delf stability`: writes stability.json and figures into `folder`, and tables to stdout. Exit code 1 if runs
/// disagree with theory, or a stress case ends in a forbidden verdict.
ExitCode stability(const Scene&, const std::filesystem::path& folder);

}  // namespace delf
