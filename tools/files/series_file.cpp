// SPDX-License-Identifier: MIT
#include "tools/files/series_file.hpp"

#include <fmt/format.h>

namespace delf {

SeriesFile::SeriesFile(const std::filesystem::path& path, const std::vector<std::string>& further) : file_(path) {
  file_.write("step,time,energy,energy_error,momentum,charge,iterations,residual");
  for (const std::string& name : further) file_.write("," + name);
  file_.write("\n");
}

void SeriesFile::append(const Record& r) {
  file_.write(fmt::format("{},{},{},{},{},{},{},{}", r.row, r.time, r.energy, r.energy_error, r.momentum, r.charge,
                          r.iterations, r.residual));
  for (const double value : r.further) file_.write(fmt::format(",{}", value));
  file_.write("\n");
}

}  // namespace delf
