// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tools/report/failure.hpp"
#include "tools/scene/keys.hpp"

namespace delf {

/// A key and the text of its value, as given: by a line of the scene, or on the command line (line 0).
struct Setting {
  std::string key, value;
  int line = 0;
};

/// A key that a scene declares, and the theory or state that reads it.
struct DeclaredKey {
  Parameter parameter;
  DeclaredBy kind;
  std::string owner;
};

/// The settings of a scene and a command line, before anything is made of them. The command line wins over the file.
class Settings {
 public:
  Settings(std::filesystem::path file, std::vector<Setting> in_file, std::vector<Setting> on_command_line);

  const std::filesystem::path& file() const noexcept { return file_; }
  const Setting* find(std::string_view key) const;
  /// All that are given, the command line first; the first of a key is in force.
  const std::vector<Setting>& all() const { return all_; }
  /// Keeps one of two keys that say the same thing: exactly one may be given in a place; the one on the command line
  /// wins, the other is forgotten.
  void keep_one_of(std::string_view key, std::string_view other, std::string_view remedy);

  /// Gives a key that nothing gives the value that another key implies, at the place of that key.
  void imply(std::string_view key, std::string_view value, std::string_view by);

  /// Keys that this scene declares itself, such as theory.m by theory.parameters.
  void declare(DeclaredKey key) { declared_.push_back(std::move(key)); }
  const std::vector<DeclaredKey>& declared() const { return declared_; }
  /// The key of that name as this scene declares it, or else as the table has it; or null.
  const Parameter* key(std::string_view name) const;
  /// The table of keys with those that the scene declares behind the others of their sections.
  std::vector<Parameter> all_keys() const;

  /// "FILE:LINE", "FILE" for a key that is not given, or "command line".
  std::string place(std::string_view key) const;
  /// "FILE:LINE: key = value: what is wrong; remedy"
  BadScene error(std::string_view key, std::string_view wrong) const;
  /// The place of an error that a library found in a value; its key is looked up.
  BadScene located(const BadInput&) const;

 private:
  std::filesystem::path file_;
  std::vector<Setting> all_;
  std::vector<DeclaredKey> declared_;
};

/// Reads the scene `file` by Boost.Program_options. Throws BadScene for whatever is no scene, for unknown keys and for
/// keys given twice; values are not checked.
Settings read_settings(const std::filesystem::path& file, const std::vector<Setting>& on_command_line);

/// Throws BadScene for an unknown key on the command line, one given twice, or a value that no scene could hold.
void check_command_line(const std::vector<Setting>& on_command_line);

}  // namespace delf
