// SPDX-License-Identifier: MIT
#include "tools/run/kept_results.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <system_error>

#include "tools/files/folder_lock.hpp"
#include "tools/report/failure.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

namespace fs = std::filesystem;

KeptResults::KeptResults(const fs::path& folder, const std::string& resolved) : folder_(folder) {
  std::ifstream in(folder / "scene.ini");
  const std::string earlier{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!earlier.starts_with(resolved_scene_begins) || earlier == resolved) return;
  const FolderLock held(folder);
  std::error_code none;
  for (int n = 1; kept_.empty() || fs::exists(kept_, none); ++n)
    kept_ = fs::path(fmt::format("{}~{}", folder.string(), n));
  std::error_code failed;
  fs::rename(folder, kept_, failed);
  if (failed) {
    kept_.clear();
    throw SystemFailure(
        fmt::format("{}: cannot be kept: {}; choose another --out, or --overwrite", folder.string(), failed.message()));
  }
}

KeptResults::~KeptResults() {
  if (kept_.empty()) return;
  std::error_code none;
  if (fs::exists(folder_ / "scene.ini", none)) {
    std::fputs(fmt::format("{}: the earlier run, kept; --overwrite keeps none\n", kept_.string()).c_str(), stdout);
    return;
  }
  fs::remove_all(folder_, none);
  fs::rename(kept_, folder_, none);
}

}  // namespace delf
