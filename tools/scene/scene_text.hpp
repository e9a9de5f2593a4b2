// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace delf {

/// The text of a scene. Throws BadScene, with what to do about it, for what is no readable text: a directory, a file
/// that is missing, too large, or binary.
std::string read_scene_text(const std::filesystem::path&);

}  // namespace delf
