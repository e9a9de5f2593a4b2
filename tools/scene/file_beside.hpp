// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

#include "tools/scene/settings.hpp"

namespace delf {

/// A file that a key names: beside the scene, where it is meant to be, or else from where the program is run.
inline std::optional<std::filesystem::path> file_beside(const Settings& settings, const std::string& name) {
  std::error_code none;
  for (const std::filesystem::path& path : {settings.file().parent_path() / name, std::filesystem::path(name)})
    if (std::filesystem::exists(path, none)) return path;
  return std::nullopt;
}

}  // namespace delf
