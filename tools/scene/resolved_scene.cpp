// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "tools/scene/keys.hpp"
#include "tools/scene/scene.hpp"
#include "tools/scene/values.hpp"

namespace delf {

namespace {

// The text that a key must have for the run to be repeated; empty if the key is better left out.
std::string resolved(const Scene& scene, const Parameter& key, StartRule start) {
  if (!why_without_effect(scene, key.key).empty()) return {};
  // keys that a run does not read
  for (const char* section : {"verify.", "workprecision.", "stability.", "sweep.", "convergence.", "reproduce.", "cite."})
    if (key.key.starts_with(section) && !scene.settings.find(key.key)) return {};
  if (key.key == "lattice.courant" || key.key == (scene.until ? "run.steps" : "run.until")) return {};
  if (key.key == "lattice.stencil") return scene.problem.stencil;  // of an alias, the name that it stands for
  if (key.key == "lattice.time_step") return fmt::format("{}", scene.problem.time_step);
  if (key.key == "run.steps") return fmt::format("{}", scene.steps);
  if (key.key == "output.every") return fmt::format("{}", scene.every);
  if (key.key == "lattice.first_row")  // of the rows that were read
    if (const auto row = scene.problem.parameters.maybe<int>(key.key)) return *row == 0 ? "" : fmt::format("{}", *row);
  // its text, unless another one is in force
  if (key.key == "scheme.tolerance" && Values(scene.settings).real(key.key) < scene.problem.tolerance)
    return fmt::format("{}", scene.problem.tolerance);
  if (key.key == "initial.start") return to_string(start);
  if (key.key == "initial.file") return scene.initial_file.string();
  return Values(scene.settings).text(key.key).value_or("");
}

}  // namespace

std::string resolved_text(const Scene& scene, StartRule in_force, const std::string& state_in_words) {
  const Problem& p = scene.problem;
  std::string text = fmt::format(
      "{}{} understood it: `delf run scene.ini` gives the same rows to the bit.\n"
      "#\n# {}\n# space step {}, Courant number {:.6g}, time of the last row {:.10g}\n",
      resolved_scene_begins, DELF_VERSION, state_in_words, p.lattice.space_step(), p.time_step / p.lattice.space_step(),
      scene.end());
  return text + sections_of(scene.settings, [&](const Parameter& key) { return resolved(scene, key, in_force); });
}

std::string sections_of(const Settings& settings, const std::function<std::string(const Parameter&)>& value_of) {
  std::string text, section;
  for (const Parameter& key : settings.all_keys()) {
    const std::string value = value_of(key);
    if (value.empty()) continue;
    if (section != section_of(key.key)) {
      section = std::string(section_of(key.key));
      text += fmt::format("\n[{}]\n", section);
    }
    text += fmt::format("{} = {}\n", key.key.substr(section.size() + 1), value);
  }
  return text;
}

}  // namespace delf
