// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

#include "tools/record.hpp"
#include "tools/text_file.hpp"

namespace delf {

/// The records as series.csv: step,time,energy,energy_error,momentum,charge,iterations,residual.
class SeriesFile {
 public:
  explicit SeriesFile(const std::filesystem::path&);
  void append(const Record&);
  void close() { file_.close(); }

 private:
  TextFile file_;
};

}  // namespace delf
