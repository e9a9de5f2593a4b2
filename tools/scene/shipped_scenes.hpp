// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace delf {

struct ShippedScene {
  std::string name;
  std::filesystem::path file;
  std::string title;  ///< its first line
};

/// The scenes that come with the program: those of its sources if they are still there, else the installed ones.
std::vector<ShippedScene> shipped_scenes();

/// The folder of this name among the scenes that come with the program; an empty path if there is none.
std::filesystem::path shipped_folder(const std::string& name);

/// The file that SCENE on a command line means: a path, or the name of a shipped scene. Throws BadScene, with the
/// nearest name, if there is none.
std::filesystem::path find_scene(const std::string& scene);

}  // namespace delf
