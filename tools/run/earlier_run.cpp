// SPDX-License-Identifier: MIT
#include "tools/run/earlier_run.hpp"

#include <fmt/format.h>

#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "tools/figures/drawing.hpp"
#include "tools/figures/figures.hpp"
#include "tools/report/failure.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

void refuse_foreign_scene(const fs::path& folder) {
  std::ifstream in(folder / "scene.ini");
  std::string first;
  if (in && std::getline(in, first) && !first.starts_with(resolved_scene_begins))
    throw BadScene(fmt::format("{}: a scene that delf did not write would be written over; choose another --out",
                               (folder / "scene.ini").string()));
}

}  // namespace

void remove_final_results(const fs::path& folder) {
  std::error_code none;
  for (const char* name : {"summary.json", "section.csv", "report.html", "film.mp4", "film.gif"})
    fs::remove(folder / name, none);
  remove_figures(figure_names(), folder);
}

void remove_earlier_run(const fs::path& folder) {
  refuse_foreign_scene(folder);
  remove_final_results(folder);
  std::error_code none;
  for (const char* name :
       {"checkpoint", "checkpoint.previous", "series.csv", "fields.h5", "fields.xdmf", "surface.xdmf", "frames.h5"})
    fs::remove(folder / name, none);
}

std::string files_of_run(const fs::path& folder) {
  std::string names;
  for (const char* name : {"summary.json", "series.csv", "section.csv", "scene.ini", "fields.h5", "fields.xdmf",
                           "surface.xdmf", "frames.h5", "figures"})
    if (std::error_code none; fs::exists(folder / name, none)) names += std::string(" ") + name;
  return names;
}

}  // namespace delf
