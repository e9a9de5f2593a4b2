// SPDX-License-Identifier: MIT
#include "tools/scene/shipped_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "lattice/text_parts.hpp"
#include "tools/report/failure.hpp"
#include "tools/scene/suggestion.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

// A package that may be installed anywhere names its own folder.
std::vector<std::string> folders() {
  std::vector<std::string> all{DELF_SCENES_SOURCE, DELF_SCENES_INSTALLED};
  if (const char* own = std::getenv("DELF_SCENES")) all.insert(all.begin(), own);
  return all;
}

std::string title_of(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return trimmed(line.substr(std::min(line.size(), line.find_first_not_of("# "))));
}

}  // namespace

std::vector<ShippedScene> shipped_scenes() {
  std::vector<ShippedScene> scenes;
  for (const std::string& folder : folders()) {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none))
      if (entry.path().extension() == ".ini")
        scenes.push_back({entry.path().stem().string(), entry.path(), title_of(entry.path())});
    if (!scenes.empty()) break;
  }
  std::sort(scenes.begin(), scenes.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return scenes;
}

fs::path shipped_folder(const std::string& name) {
  std::error_code none;
  for (const std::string& folder : folders())
    if (const fs::path path = fs::path(folder) / name; fs::is_directory(path, none)) return path;
  return {};
}

fs::path find_scene(const std::string& scene) {
  std::error_code none;
  const fs::path path(scene);
  const bool exists = fs::exists(path, none);
  if (exists && !fs::is_directory(path, none)) return path;
  const bool name_only = !scene.empty() && !path.has_parent_path();
  for (const std::string& folder : folders()) {  // without a look into the other scenes
    const fs::path file = fs::path(folder) / (scene + ".ini");
    if (name_only && fs::is_regular_file(file, none)) return file;
  }
  const auto shipped = name_only ? shipped_scenes() : std::vector<ShippedScene>();
  for (const ShippedScene& s : shipped)
    if (s.name == scene) return s.file;
  if (exists) return path;  // a directory: whoever reads it says so
  if (!name_only) throw BadScene(fmt::format("{}: no such file; check the path", scene));
  std::vector<std::string> names;
  for (const ShippedScene& s : shipped) names.push_back(s.name);
  if (names.empty()) throw BadScene(fmt::format("{}: no such file, and no shipped scenes are installed", scene));
  const std::string bare = path.extension() == ".ini" ? path.stem().string() : scene;
  throw BadScene(fmt::format("{}: no such file or shipped scene{}", scene, suggestion(bare, names)));
}

}  // namespace delf
