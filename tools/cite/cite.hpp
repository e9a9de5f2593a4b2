// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/report/failure.hpp"
#include "tools/scene/settings.hpp"

namespace delf {

/// `delf cite`: prints the methods section of a scene, or of the folder of its results, in the format of cite.format; with
/// `out`, a folder, writes methods.tex, methods.md and references.bib there.
ExitCode cite(const std::string& scene_or_folder, const std::vector<Setting>& on_command_line,
              const std::optional<std::string>& out);

/// The entries of references.bib that these keys name, as BibTeX; keys of a program's own entries are left to it.
std::string bibliography_of(const std::vector<std::string>& keys);

}  // namespace delf
