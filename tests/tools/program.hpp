// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace delf::testing {

/// A folder of its own for a test, gone when the test is.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  /// Writes a file, and gives its path.
  std::string write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

/// What a command left.
struct Ran {
  int code;
  std::string out, err;
};

/// The path of the program under test.
std::string program_path();
/// The folder of the scenes in the source tree.
std::string scenes_folder();

/// Runs a line of shell in `folder`.
Ran shell(const Folder&, const std::string& line);
/// Runs `delf ARGUMENTS` in `folder`, after the `before` of a shell.
Ran delf_program(const Folder&, const std::string& arguments, const std::string& before = "");

std::string read(const std::filesystem::path&);
std::vector<std::string> lines(const std::string& text);
bool contains(const std::string& text, const std::string& part);
/// Stderr without the lines of progress, which a slow machine prints: warnings and errors.
std::string complaints(const Ran&);

/// A small scene that runs in no time: 100 steps of sine-Gordon.
std::string small_scene(const std::string& more = "");

}  // namespace delf::testing
