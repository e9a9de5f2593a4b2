// SPDX-License-Identifier: MIT
#include "tools/cite/cite.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "lattice/text_parts.hpp"
#include "tools/cite/methods_text.hpp"
#include "tools/cite/references.hpp"
#include "tools/files/text_file.hpp"
#include "tools/scene/shipped_scenes.hpp"
#include "tools/scene/suggestion.hpp"
#include "tools/scene/values.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

constexpr auto format_key = "cite.format", sources_key_of_scene = "cite.sources";

std::vector<std::string> all_keys_of_references() {
  std::vector<std::string> keys;
  for (const CitedWork& reference : references()) keys.push_back(reference.key);
  return keys;
}

/// Throws BadScene for keys of cite.sources that no reference has.
void check_sources(const Settings& settings) {
  for (const std::string& key : parts_of(Values(settings).text(sources_key_of_scene).value_or(""), ','))
    if (!key.empty() && !find_reference(key))
      throw settings.error(sources_key_of_scene, fmt::format("{}: is no key of references.bib{}", key,
                                                             suggestion(key, all_keys_of_references())));
}

/// The scene.ini of a folder, whose keys are in force as they are.
fs::path scene_of(const ResultFolder& folder, const std::vector<Setting>& on_command_line) {
  for (const Setting& setting : on_command_line)
    if (!setting.key.starts_with("cite."))
      throw BadScene(fmt::format("command line: --{}: {} says what its results were made with; leave it out",
                                 setting.key, (folder.path / "scene.ini").string()));
  if (folder.scene.empty())
    throw BadScene(
        fmt::format("command line: cite {}: has no scene.ini, which says what was computed; name the scene, or run it "
                    "with --output.report=on",
                    folder.path.string()));
  return folder.scene_file;
}

}  // namespace

std::string bibliography_of(const std::vector<std::string>& keys) {
  std::string text;
  for (const std::string& key : keys)
    if (const CitedWork* reference = find_reference(key)) text += reference->bibtex;
  return text;
}

ExitCode cite(const std::string& scene_or_folder, const std::vector<Setting>& on_command_line,
              const std::optional<std::string>& out) {
  check_command_line(on_command_line);
  std::error_code none;
  std::optional<ResultFolder> folder;
  if (fs::is_directory(scene_or_folder, none)) folder.emplace(scene_or_folder, "cite");
  Settings settings =
      read_settings(folder ? scene_of(*folder, on_command_line) : find_scene(scene_or_folder), on_command_line);
  const std::string format = Values(settings).choice(format_key);
  check_sources(settings);
  AnyScene any = read_any_scene(std::move(settings));
  const PaperText text =
      std::visit([&](const auto& scene) { return methods_text(scene, folder ? &*folder : nullptr); }, any);
  if (!out) {
    fmt::print("{}", text.in(format == "latex"      ? PaperFormat::latex
                             : format == "markdown" ? PaperFormat::markdown
                                                    : PaperFormat::text));
    return ExitCode::done;
  }
  make_results_folder(*out);
  const fs::path where = *out;
  write_text_file(where / "methods.tex", text.in(PaperFormat::latex));
  write_text_file(where / "methods.md", text.in(PaperFormat::markdown));
  write_text_file(where / "references.bib", bibliography_of(text.cited()));
  fmt::print("{0}/methods.tex, {0}/methods.md and {0}/references.bib\n", where.string());
  return ExitCode::done;
}

}  // namespace delf
