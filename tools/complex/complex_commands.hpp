// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/complex/complex_scene.hpp"
#include "tools/report/failure.hpp"
#include "tools/run/run.hpp"

namespace delf {

/// `delf run`, `delf plan` and `delf verify` of a scene on a mesh. With `resumed`, the run of that folder goes on from there.
ExitCode run(const ComplexScene&, const std::filesystem::path& folder, Resumed resumed = {});
ExitCode plan(const ComplexScene&, bool latex);
ExitCode verify(const ComplexScene&, const std::filesystem::path& folder, const std::optional<std::string>& fields,
                const std::vector<std::string>& nearby);

}  // namespace delf
