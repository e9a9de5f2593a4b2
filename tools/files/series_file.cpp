// SPDX-License-Identifier: MIT
#include "tools/files/series_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "lattice/index.hpp"
#include "tools/report/failure.hpp"

namespace delf {

void require_part(const std::filesystem::path& path, const WrittenPart& kept) {
  std::error_code error;
  const auto there = std::filesystem::file_size(path, error);
  if (error) throw BadScene(fmt::format("{}: {}; begin the run anew", path.string(), error.message()));
  if (there < kept.size)
    throw BadScene(fmt::format("{}: has {} bytes, and the checkpoint counts on {}; begin the run anew", path.string(),
                               there, kept.size));
  std::ifstream in(path, std::ios::binary);
  std::string block(1 << 16, '\0');
  Checksum sum;
  for (std::uint64_t left = kept.size; left > 0 && in;) {
    in.read(block.data(), static_cast<std::streamsize>(std::min<std::uint64_t>(left, block.size())));
    sum.add(std::string_view(block).substr(0, at(in.gcount())));
    left -= static_cast<std::uint64_t>(in.gcount());
  }
  if (sum != kept.sum)
    throw BadScene(fmt::format(
        "{}: is damaged: its lines are not those that the checkpoint counts on; begin the run anew", path.string()));
}

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
