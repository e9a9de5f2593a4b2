// SPDX-License-Identifier: MIT
#include "tools/series_file.hpp"

#include <fmt/format.h>

namespace delf {

SeriesFile::SeriesFile(const std::filesystem::path& path) : file_(path) {
  file_.write("step,time,energy,energy_error,momentum,charge,iterations,residual\n");
}

void SeriesFile::append(const Record& r) {
  file_.write(fmt::format("{},{},{},{},{},{},{},{}\n", r.row, r.time, r.energy, r.energy_error, r.momentum, r.charge,
                          r.iterations, r.residual));
}

}  // namespace delf
