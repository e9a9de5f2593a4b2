// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/outcome/outcome.hpp"
#include "tools/report/failure.hpp"
#include "tools/scene/scene.hpp"
#include "tools/verify/verdict.hpp"

namespace delf {

struct ComplexScene;

/// A scene of rows in a file needs no start and no end: what it does not say of them is that file, and no step.
void imply_rows(Settings&, const std::string& fields);

/// `delf verify`: checks the rows of a scene, or those of the file `fields`, and writes verify.json and figures into
/// `folder`. The exit code reports a failed check.
ExitCode verify(const Scene&, const std::filesystem::path& folder, const std::optional<std::string>& fields,
                const std::vector<std::string>& nearby);
/// Checks the rows of a scene on a mesh, or those of a file, and writes verify.json.
ExitCode verify(const ComplexScene&, const std::filesystem::path& folder, const std::optional<std::string>& fields,
                const std::vector<std::string>& nearby);

/// Writes the results of a verification in place of earlier ones, and reports them. Figures have a `title`; without it there
/// are none.
ExitCode write_verdict(const Verdict&, const Subject&, const Scene&, const std::filesystem::path& folder,
                       const std::string& title = {});

}  // namespace delf
