// SPDX-License-Identifier: MIT
#include "tools/files/series_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "lattice/index.hpp"

namespace delf {

SeriesTable::SeriesTable(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::string line, cell;
  if (!std::getline(in, line)) return;
  for (std::istringstream head(line); std::getline(head, cell, ',');) names.push_back(cell);
  columns.resize(names.size());
  while (std::getline(in, line)) {
    if (in.eof()) break;
    const char* rest = line.c_str();
    for (std::vector<double>& values : columns) {
      char* end = nullptr;
      const double value = std::strtod(rest, &end);
      values.push_back(end == rest ? NAN : value);
      rest = *end == ',' ? end + 1 : end;
    }
  }
  if (columns.empty() || columns.front().empty() || !column("time")) columns.clear(), names.clear();
}

const std::vector<double>* SeriesTable::column(const std::string& name) const {
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? nullptr : &columns[at(found - names.begin())];
}

}  // namespace delf
