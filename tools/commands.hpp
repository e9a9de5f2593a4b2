// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/failure.hpp"
#include "tools/settings.hpp"

namespace delf {

/// A command line, taken apart.
struct Arguments {
  std::vector<std::string> words;  ///< the command, and what it is applied to
  std::vector<Setting> keys;       ///< --KEY=VALUE
  std::optional<std::string> out;  ///< --out
  bool help = false, version = false;
};

struct Command {
  std::string name, usage, summary, details;
  bool reads_scene;
  ExitCode (*carry_out)(const Arguments&);
};

/// What this version has.
std::span<const Command> commands();
/// Throws BadScene: for a name that there is none of, with the nearest one; for one that a later version will have.
const Command& find_command(const std::string& name);

}  // namespace delf
