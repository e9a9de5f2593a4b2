// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

#include "tools/failure.hpp"
#include "tools/scene/scene.hpp"
#include "tools/stability/stability_findings.hpp"
#include "tools/stability/stability_request.hpp"

namespace delf {

/// Limits by theory and by running, corners, maps and dispersion: what is asked for. Ends early when interrupted.
StabilityFindings find_stability(const StabilityRequest&, const Problem& base);

/// `delf stability`: writes stability.json and figures into `folder`, and tables to stdout. Exit code 1 if runs disagree
/// with theory, or a corner ends in what must not be.
ExitCode stability(const Scene&, const std::filesystem::path& folder);

}  // namespace delf
