// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/report/failure.hpp"
#include "tools/scene/settings.hpp"

namespace delf {

/// A parsed command line.
struct Arguments {
  std::vector<std::string> words;     ///< the command and its operands
  std::vector<Setting> keys;          ///< --KEY=VALUE
  std::optional<std::string> out;     ///< --out
  std::optional<std::string> fields;  ///< --fields: recorded rows to verify
  std::vector<std::string> nearby;    ///< --nearby, as often as given: solutions near those rows
  bool help = false, version = false;
  std::optional<int> modified;  ///< --modified: the order of a modified Lagrangian
  bool latex = false;           ///< --latex: the equations of a plan for a paper
  bool overwrite = false;       ///< --overwrite: keep nothing of an earlier run of the scene
};

struct Command {
  std::string name, usage, summary, details;
  bool reads_scene;
  ExitCode (*carry_out)(const Arguments&);
  std::string_view section = {};  ///< of the keys that its help lists; all if empty
  bool reads_rows = false;        ///< takes --fields and --nearby; they are refused before any other is carried out
  bool writes_latex = false;      ///< takes --latex and --modified
  bool keeps_earlier = false;     ///< takes --overwrite
  std::string_view also = {};     ///< a section of another command that it reads too
};

/// The commands of this version.
std::span<const Command> commands();
/// A warning for each key that another command alone reads. A scene serves many commands, and has the sections of some;
/// what is given beside it is meant.
std::vector<std::string> keys_of_other_commands(const std::string& command, const std::vector<Setting>& keys);
/// Throws BadScene for an unknown name, with the nearest known one, and for a command of a later version.
const Command& find_command(const std::string& name);

}  // namespace delf
