// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

#include "tools/files/written_part.hpp"

namespace delf {

/// A text file that reaches the disk, or throws SystemFailure naming it.
class TextFile {
 public:
  explicit TextFile(const std::filesystem::path&);
  /// Goes on with a file behind its first bytes; what follows them is cut off.
  TextFile(const std::filesystem::path&, const WrittenPart& kept);
  void write(std::string_view);
  /// Hands what has been written so far to the system, and with `sync` to the disk.
  void flush(bool sync = false);
  /// Bytes from its beginning.
  const WrittenPart& written() const { return written_; }
  /// Writes what still waits; without it nothing is promised.
  void close();

 private:
  [[noreturn]] void fail() const;
  std::filesystem::path path_;
  WrittenPart written_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

/// A folder for results, made if it is not there. Throws SystemFailure.
void make_results_folder(const std::filesystem::path&);

/// The whole file at once, or not at all: it is written beside the one of that name, and takes its place. A link stays, and
/// what it points at is written; a device or a pipe is written to.
void write_text_file(const std::filesystem::path&, std::string_view);

}  // namespace delf
