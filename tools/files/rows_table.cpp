// SPDX-License-Identifier: MIT
#include "tools/files/rows_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>

#include "lattice/error.hpp"
#include "lattice/read_number.hpp"
#include "lattice/text_parts.hpp"
#include "tools/files/fields_reader.hpp"

namespace delf {

RowsTable::RowsTable(const std::filesystem::path& path) {
  std::ifstream in(path);
  int at = 0;
  const auto wrong = [&](const std::string& what) {
    return BadInput("initial.file", at == 0 ? what : fmt::format("line {}: {}", at, what));
  };
  if (!in) throw wrong("cannot be read; check its permissions");

  struct Entry {
    int row, site, line;
    std::size_t values;  ///< where they begin
    double time;
  };
  std::vector<Entry> entries;
  std::vector<double> values;
  std::size_t columns = 0, of_time = 0;  // 0: no column has it
  for (std::string line; std::getline(in, line);) {
    ++at;
    if (at == 1 && line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);
    line = trimmed(line);
    if (line.empty() || line.front() == '#') continue;
    const auto cells = parts_of(line);
    if (columns == 0) {
      if (cells.size() < 3 || cells[0] != "row" || cells[1] != "site")
        throw wrong("is no header of rows; begin the table with row,site and the names of the fields");
      columns = cells.size();
      for (std::size_t c = 2; c < columns; ++c)
        if (cells[c] != "t" && cells[c] != "time") names_.push_back(cells[c]);
        else if (of_time == 0) of_time = c;
        else throw wrong("names the time twice; keep one column of it");
      if (names_.empty()) throw wrong("names no field; give one after row,site and the time");
      continue;
    }
    if (cells.size() != columns)
      throw wrong(fmt::format("has {} columns, and the header has {}; give as many", cells.size(), columns));
    const auto row = read_number<int>(cells[0]), site = read_number<int>(cells[1]);
    if (!row || !site || *row < 0 || *site < 0)
      throw wrong("row and site are integers that count from 0; correct them");
    entries.push_back({*row, *site, at, values.size(), 0});
    for (std::size_t c = 2; c < columns; ++c) {
      const auto value = read_number<double>(cells[c]);
      if (!value || !std::isfinite(*value))
        throw wrong(fmt::format("\"{}\" is not a finite number; write one like 0.125", cells[c].substr(0, 30)));
      if (c == of_time) entries.back().time = *value;
      else values.push_back(*value);
    }
  }
  at = 0;
  if (entries.empty()) throw wrong("holds no rows; give a header row,site,NAME and a line for each site of each row");

  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return std::pair(a.row, a.site) < std::pair(b.row, b.site); });
  for (const Entry& e : entries) sites_ = std::max(sites_, e.row == 0 ? e.site + 1 : 0);
  int row = 0, site = 0;  // that must come next
  for (const Entry& e : entries) {
    if (sites_ > 0 && site == sites_) ++row, site = 0;
    if (e.row != row || e.site != site) {
      at = e.line;
      if (std::pair(e.row, e.site) < std::pair(row, site))
        throw wrong(fmt::format("row {}, site {} is given twice; keep one of them", e.row, e.site));
      throw wrong(
          fmt::format("row {}, site {} is given, but not row {}, site {}; give every site of every row, and as many "
                      "in each",
                      e.row, e.site, row, site));
    }
    ++site;
    if (of_time > 0 && site == 1) times_.push_back(e.time);
    if (of_time > 0 && e.time != times_.back()) {
      at = e.line;
      throw wrong(
          fmt::format("row {} is at time {} here, and at {} before; a row has one time", e.row, e.time, times_.back()));
    }
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(e.values);
    values_.insert(values_.end(), first, first + static_cast<std::ptrdiff_t>(names_.size()));
  }
  if (site != sites_) throw wrong(fmt::format("row {} ends at site {} of {}; give every site", row, site, sites_));
  frames_ = row + 1;
  components_ = static_cast<int>(names_.size());
}

std::optional<double> RowsTable::time(int frame) const {
  return frame < static_cast<int>(times_.size()) ? std::optional(times_[frame]) : std::nullopt;
}

std::vector<double> RowsTable::row(int frame) const {
  if (frame >= frames_)
    throw BadInput("initial.frame",
                   fmt::format("row {} is needed, and the file has {} of them; give it more", frame, frames_));
  const auto size = static_cast<std::ptrdiff_t>(sites_) * components_;
  const auto first = values_.begin() + frame * size;
  return {first, first + size};
}

std::unique_ptr<RowsFile> open_rows(const std::filesystem::path& path) {
  if (path.extension() == ".csv") return std::make_unique<RowsTable>(path);
  return std::make_unique<FieldsReader>(path);
}

}  // namespace delf
