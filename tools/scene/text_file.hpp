// SPDX-License-Identifier: MIT
#pragma once
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace delf {

/// A text file that reaches the disk, or throws SystemFailure naming it.
class TextFile {
 public:
  explicit TextFile(const std::filesystem::path&);
  void write(std::string_view);
  /// Writes what still waits; without it nothing is promised.
  void close();

 private:
  [[noreturn]] void fail() const;
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

/// A folder for results, made if it is not there. Throws SystemFailure.
void make_results_folder(const std::filesystem::path&);

/// The whole file at once.
void write_text_file(const std::filesystem::path&, std::string_view);

}  // namespace delf
