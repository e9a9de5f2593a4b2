// SPDX-License-Identifier: MIT
#include "tools/help.hpp"

#include <fmt/format.h>

#include "tools/commands.hpp"
#include "tools/scene/keys.hpp"

namespace delf {

namespace {

void print_keys(std::string_view only) {
  std::string_view section;
  for (const Key& key : keys()) {
    if (!only.empty() && !key.name.starts_with(only)) continue;
    if (const auto now = section_of(key.name); now != section) {
      section = now;
      fmt::print("\n[{}]\n", section);
    }
    const auto value = key.fallback.empty() ? key.otherwise : key.fallback;
    fmt::print("  {:<22} {}{} ({})\n", key.name, key.meaning, key.unit.empty() ? "" : fmt::format(" [{}]", key.unit),
               value);
  }
}

}  // namespace

std::string usage() {
  std::string text = "delf: a discrete multisymplectic lattice engine\n\n";
  for (const Command& c : commands()) text += fmt::format("  {:<52} {}\n", c.usage, c.summary);
  return text + "  delf --version\n\nSCENE is a file, or the name of a shipped scene: `delf run collision`.\n";
}

ExitCode help(const std::string& name) {
  if (name.empty()) {
    fmt::print("{}`delf help run` lists the keys of a scene.\n", usage());
    return ExitCode::done;
  }
  const Command& command = find_command(name);
  fmt::print("{}\n\n{}\n", command.usage, command.details);
  if (command.reads_scene) print_keys(command.section);
  return ExitCode::done;
}

}  // namespace delf
