// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "tools/files/record.hpp"
#include "tools/files/text_file.hpp"

namespace delf {

/// The records as series.csv: step,time,energy,energy_error,momentum,charge,iterations,residual,
/// and what the scheme has further.
class SeriesFile {
 public:
  SeriesFile(const std::filesystem::path&, const std::vector<std::string>& further);
  /// Goes on behind the first bytes of a file.
  SeriesFile(const std::filesystem::path& path, const WrittenPart& kept) : file_(path, kept) {}
  void append(const Record&);
  /// Returns what has reached the system, and with `sync` the disk.
  const WrittenPart& flush(bool sync) { return file_.flush(sync), file_.written(); }
  void close() { file_.close(); }

 private:
  TextFile file_;
};

/// Throws BadScene if the file does not begin so: where it was cut off, it would be filled with zeros, and what was changed
/// in it would stay.
void require_part(const std::filesystem::path&, const WrittenPart& kept);

}  // namespace delf
