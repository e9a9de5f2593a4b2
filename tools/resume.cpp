// SPDX-License-Identifier: MIT
#include "tools/resume.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string>
#include <variant>

#include "tools/complex/mesh_run.hpp"
#include "tools/files/checkpoint_file.hpp"
#include "tools/run/checkpoints.hpp"
#include "tools/run/run.hpp"
#include "tools/scene/recorded_scene.hpp"
#include "tools/scene/scene.hpp"
#include "tools/scene/scene_text.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

const std::vector<std::string> harmless{"run.until",     "run.steps",     "run.threads",     "output.checkpoint",
                                        "output.format", "output.titles", "output.report",   "output.xdmf",
                                        "output.film",   "film.seconds",  "figures.spectrum"};
bool is_harmless(const std::string& key) { return std::ranges::find(harmless, key) != harmless.end(); }

// Throws BadScene if a key that matters has another value than the run began with.
void check_unchanged(const fs::path& file, const std::string& began_with) {
  const auto now = recorded_keys(read_scene_text(file)), then = recorded_keys(began_with);
  const auto refuse = [&](const std::string& key, const std::string& value) {
    throw BadScene(fmt::format("{}: {}: the run began with {}; put that back, or begin a new run from this file",
                               file.string(), key, value.empty() ? "none" : value));
  };
  for (const auto& [key, value] : then)
    if (const auto found = now.find(key); !is_harmless(key) && (found == now.end() || found->second != value))
      refuse(key, value);
  for (const auto& [key, value] : now)
    if (!is_harmless(key) && !then.contains(key)) refuse(key, "");
}

void check_given(const std::vector<Setting>& given) {
  for (const Setting& s : given)
    if (!is_harmless(s.key))
      throw BadScene(
          fmt::format("command line: --{} = {}: a run is resumed with the keys that it began with; only {} may change",
                      s.key, s.value, fmt::join(harmless, ", ")));
}

// The newest checkpoint that is whole.
Resumed newest_checkpoint(const fs::path& folder) {
  std::string why;
  for (const char* ending : {"", ".previous"}) {
    const fs::path file = folder / (std::string(Checkpoints::file_name) + ending);
    std::error_code none;
    if (!fs::exists(file, none)) continue;
    try {
      Resumed found{std::make_unique<CheckpointReader>(file), {}};
      found.head.visit(*found.state);
      if (!why.empty()) fmt::print(stderr, "{}; the one before it, of row {}, is taken\n", why, found.head.row);
      return found;
    } catch (const BadInput& bad) {
      why = fmt::format("{}: {}", file.string(), bad.what());
    }
  }
  if (!why.empty()) throw BadScene(why + "; begin the run anew");
  if (std::error_code none; fs::exists(folder / "summary.json", none))
    throw BadScene(
        fmt::format("{}: there is no checkpoint to resume from: the run has ended without one, as "
                    "those without time or with output.checkpoint = 0 do; run {} anew",
                    folder.string(), (folder / "scene.ini").string()));
  throw BadScene(
      fmt::format("{}: there is no checkpoint to resume from; name the folder of a run, and see "
                  "output.checkpoint",
                  folder.string()));
}

}  // namespace

ExitCode resume(const fs::path& folder, const std::vector<Setting>& on_command_line) {
  check_given(on_command_line);
  Resumed resumed = newest_checkpoint(folder);
  const CheckpointHead& head = resumed.head;
  const auto refuse = [&](const std::string& why) { throw BadScene(fmt::format("{}: {}", folder.string(), why)); };
  if (head.version != DELF_VERSION)
    refuse(fmt::format("the run was made by delf {}, and this is {}; its bits may differ: begin it anew", head.version,
                       DELF_VERSION));
  if (head.instructions != instruction_set())
    refuse(
        fmt::format("the run was made with {}, and this machine and build have {}, which round otherwise; resume "
                    "it there, or begin it anew",
                    head.instructions, instruction_set()));
  check_unchanged(folder / "scene.ini", head.scene);
  const auto take_over = [&](Scene& scene) {
    scene.name = head.name;
    scene.warnings = head.warnings;
    // The number of steps is a guess where the field chooses them, and the time tells if the run is over.
    if (scene.until) scene.steps = std::max(scene.steps, head.row + 1);
    if (std::error_code none; head.row >= scene.steps && fs::exists(folder / "summary.json", none))
      refuse(fmt::format("the run is finished, at row {}; to go on, raise run.until or run.steps, as --run.steps={}",
                         head.row, 2 * std::max<std::int64_t>(1, head.row)));
    if (head.row > scene.steps)
      refuse(fmt::format("the run is at row {}, beyond run.steps = {}; raise run.until or run.steps", head.row,
                         scene.steps));
  };
  AnyScene any = read_any_scene(read_settings(folder / "scene.ini", on_command_line));
  return std::visit(
      [&](auto& scene) {
        take_over(common_part(scene));
        return run(scene, folder, std::move(resumed));
      },
      any);
}

}  // namespace delf
