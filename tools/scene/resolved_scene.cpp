// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "tools/scene/keys.hpp"
#include "tools/scene/scene.hpp"
#include "tools/scene/values.hpp"

namespace delf {

namespace {

// The text that a key must have for the run to be repeated; empty if the key is better left out.
std::string resolved(const Scene& scene, const Key& key, StartRule start) {
  if (!why_without_effect(scene, key.name).empty()) return {};
  // keys that a run does not read
  for (const char* section : {"verify.", "workprecision.", "stability.", "sweep.", "convergence."})
    if (key.name.starts_with(section) && !scene.settings.find(key.name)) return {};
  if (key.name == "lattice.courant" || key.name == (scene.until ? "run.steps" : "run.until")) return {};
  if (key.name == "lattice.stencil") return scene.problem.stencil;  // of an alias, the name that it stands for
  if (key.name == "lattice.time_step") return fmt::format("{}", scene.problem.time_step);
  if (key.name == "run.steps") return fmt::format("{}", scene.steps);
  if (key.name == "output.every") return fmt::format("{}", scene.every);
  if (key.name == "lattice.first_row")  // of the rows that were read
    if (const auto row = scene.problem.parameters.maybe<int>(key.name)) return *row == 0 ? "" : fmt::format("{}", *row);
  // its text, unless another one is in force
  if (key.name == "scheme.tolerance" && Values(scene.settings).real(key.name) < scene.problem.tolerance)
    return fmt::format("{}", scene.problem.tolerance);
  if (key.name == "initial.start") return to_string(start);
  if (key.name == "initial.file") return scene.initial_file.string();
  return Values(scene.settings).text(key.name).value_or("");
}

}  // namespace

std::string resolved_text(const Scene& scene, StartRule in_force, const std::string& state_in_words) {
  const Problem& p = scene.problem;
  std::string text = fmt::format(
      "{}{} understood it: `delf run scene.ini` gives the same rows to the bit.\n"
      "#\n# {}\n# space step {}, Courant number {:.6g}, time of the last row {:.10g}\n",
      resolved_scene_begins, DELF_VERSION, state_in_words, p.lattice.space_step(), p.time_step / p.lattice.space_step(),
      scene.end());
  return text + sections_of(scene.settings, [&](const Key& key) { return resolved(scene, key, in_force); });
}

std::string sections_of(const Settings& settings, const std::function<std::string(const Key&)>& value_of) {
  std::string text, section;
  for (const Key& key : settings.all_keys()) {
    const std::string value = value_of(key);
    if (value.empty()) continue;
    if (section != section_of(key.name)) {
      section = std::string(section_of(key.name));
      text += fmt::format("\n[{}]\n", section);
    }
    text += fmt::format("{} = {}\n", key.name.substr(section.size() + 1), value);
  }
  return text;
}

}  // namespace delf
