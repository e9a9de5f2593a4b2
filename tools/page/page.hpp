// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/report/failure.hpp"

namespace delf {

/// The page of one folder of results, or of several side by side: one file of HTML of at most a million bytes. It is made
/// of what the folders hold, and says what is missing there. Its links to films begin at `place`, the folder it is for. Throws
/// BadInput for a folder without results.
std::string page_of(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& place);

/// `delf report DIR …`: writes the page to `out`, or to report.html in the folder, of several in the current one.
ExitCode write_page(const std::vector<std::filesystem::path>& folders, const std::optional<std::string>& out);

}  // namespace delf
