// SPDX-License-Identifier: MIT
#include "tools/bench/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "lattice/index.hpp"

namespace delf::bench {

namespace {

/// Code points, each a column on a terminal.
std::size_t columns_of(const std::string& text) {
  return at(std::ranges::count_if(text, [](char c) { return (c & 0xc0) != 0x80; }));
}

}  // namespace

Table::Table(std::vector<Column> columns) : columns_(std::move(columns)) {
  std::vector<std::string> headings;
  for (const Column& column : columns_) headings.push_back(column.heading);
  row(headings);
}

void Table::row(const std::vector<std::string>& cells) const {
  std::string line;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const std::string blanks(columns_[c].width - std::min(columns_[c].width, columns_of(cells[c])), ' ');
    line += c == 0 ? cells[c] + blanks : "  " + blanks + cells[c];
  }
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

std::string number(double x) {
  return x < 1 ? fmt::format("{:.3f}", x) : x < 1000 ? fmt::format("{:.3g}", x) : fmt::format("{:.0f}", x);
}

std::string in_words(const Spread& spread) {
  return fmt::format("{} ({} … {})", number(spread.median), number(spread.least), number(spread.most));
}

}  // namespace delf::bench
