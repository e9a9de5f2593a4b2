// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace delf {

/// SHA-256 of files of a folder, by their names in it, as the program sha256sum of the coreutils finds them; without that
/// program nothing, and of a file that it cannot read nothing.
std::map<std::string, std::string> sha256_of(const std::filesystem::path& folder,
                                             const std::vector<std::string>& files);

}  // namespace delf
