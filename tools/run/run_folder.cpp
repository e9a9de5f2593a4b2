// SPDX-License-Identifier: MIT
#include "tools/run/run_folder.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "tools/files/text_file.hpp"
#include "tools/run/earlier_run.hpp"

namespace delf {

namespace fs = std::filesystem;

RunFolder::Made::Made(const fs::path& folder) { make_results_folder(folder); }

RunFolder::RunFolder(const fs::path& path, const Resumed& resumed, Outcome& outcome)
    : path_(path), resumed_(resumed), outcome_(outcome), made_(path), lock_(path), failures_(outcome) {
  if (!resumed.state) remove_earlier_run(path);
  room_.emplace(path);
}

Checkpoints RunFolder::begin(RunFiles& files, const Scene& scene, const std::string& resolved) {
  if (resumed_.state) {
    files.visit(*resumed_.state);
    remove_final_results(path_);  // now that the run can go on
  }
  write_text_file(path_ / "scene.ini", resolved);
  return {path_, {DELF_VERSION, instruction_set(), resolved, scene.name, scene.warnings}, scene.checkpoint};
}

ExitCode RunFolder::end(const Subject& subject, const Scene& scene, const std::function<std::string()>& draw) {
  attempt([&] { write_text_file(path_ / "summary.json", summary_json(subject, scene, outcome_)); });
  if (outcome_.status != "system-failure") {
    std::string missing;
    try {
      missing = draw();  // last: all files are whole. A run does not fail if a figure cannot be drawn.
    } catch (const std::exception& error) {
      missing = error.what();
    }
    fmt::print("{}  {:<10} {}:{}\n", report(subject, scene, outcome_), "files", path_.string(), files_of_run(path_));
    if (!missing.empty()) std::fputs(fmt::format("delf: no figures: {}\n", missing).c_str(), stderr);
  }
  if (failures_.first()) std::rethrow_exception(failures_.first());
  return outcome_.status == "interrupted" ? ExitCode::interrupted : ExitCode::done;
}

}  // namespace delf
