// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/failure.hpp"
#include "tools/scene/settings.hpp"

namespace delf {

/// A command line, taken apart.
struct Arguments {
  std::vector<std::string> words;     ///< the command, and what it is applied to
  std::vector<Setting> keys;          ///< --KEY=VALUE
  std::optional<std::string> out;     ///< --out
  std::optional<std::string> fields;  ///< --fields: recorded rows to look at
  std::vector<std::string> nearby;    ///< --nearby, as often as given: solutions near those rows
  bool help = false, version = false;
};

struct Command {
  std::string name, usage, summary, details;
  bool reads_scene;
  ExitCode (*carry_out)(const Arguments&);
  std::string_view section = {};  ///< of the keys that its help lists; all if empty
  bool reads_rows = false;  ///< takes --fields and --nearby; they are refused before any other is carried out
};

/// What this version has.
std::span<const Command> commands();
/// Throws BadScene: for a name that there is none of, with the nearest one; for one that a later version will have.
const Command& find_command(const std::string& name);

}  // namespace delf
