// SPDX-License-Identifier: MIT
#include "tools/report/text_columns.hpp"

#include <algorithm>

#include "lattice/index.hpp"

namespace delf {

namespace {

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

// The bytes that the first `width` columns take.
std::size_t bytes_of(std::string_view text, std::size_t width) {
  std::size_t at = 0;
  for (; at < text.size(); ++at)
    if (!continues(text[at]) && width-- == 0) break;
  return at;
}

std::string padded(const std::string& text, std::size_t width, bool right) {
  const std::string blanks(width - std::min(width, columns_of(text)), ' ');
  return right ? blanks + text : text + blanks;
}

// One row, of as many lines as its tallest text.
std::string table_row(const std::vector<TextColumn>& columns, const std::vector<std::string>& row,
                      const std::vector<std::size_t>& widths) {
  std::vector<std::vector<std::string>> cells;
  std::size_t height = 1;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    cells.push_back(wrapped(row[c], widths[c]));
    height = std::max(height, cells.back().size());
  }
  std::string text;
  for (std::size_t h = 0; h < height; ++h) {
    std::string line;
    for (std::size_t c = 0; c < columns.size(); ++c)
      line += "  " + padded(h < cells[c].size() ? cells[c][h] : "", widths[c], columns[c].right);
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace

std::size_t columns_of(std::string_view text) {
  return delf::at(std::ranges::count_if(text, [](char c) { return !continues(c); }));
}

std::vector<std::string> wrapped(std::string_view text, std::size_t width) {
  constexpr std::string_view blank = " \t\r\n";
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t at = 0; (at = text.find_first_not_of(blank, at)) != text.npos;) {
    std::string_view word = text.substr(at, text.find_first_of(blank, at) - at);
    at += word.size();
    if (!line.empty() && columns_of(line) + 1 + columns_of(word) > width) {
      lines.push_back(line);
      line.clear();
    }
    for (; columns_of(word) > width; word.remove_prefix(bytes_of(word, width)))
      lines.emplace_back(word.substr(0, bytes_of(word, width)));
    if (!line.empty()) line += ' ';
    line += word;
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

std::string shortened(std::string_view text, std::size_t width) {
  if (columns_of(text) <= width) return std::string(text);
  return std::string(text.substr(0, bytes_of(text, width - 1))) + "…";
}

std::string text_table(const std::vector<TextColumn>& columns, const std::vector<std::vector<std::string>>& rows,
                       std::size_t width) {
  std::vector<std::size_t> widths;
  std::vector<std::string> headings;
  std::size_t total = 0;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::size_t widest = columns_of(columns[c].heading);
    for (const auto& row : rows) widest = std::max(widest, columns_of(row[c]));
    widths.push_back(columns[c].widest == 0 ? widest : std::min(widest, columns[c].widest));
    headings.push_back(columns[c].heading);
    total += 2 + widths.back();
  }
  constexpr std::size_t narrowest = 20;
  for (std::size_t c = 0; c < columns.size(); ++c)
    if (const std::size_t w = widths[c]; columns[c].rest && total > width && w > narrowest)
      widths[c] = std::max(narrowest, w - std::min(w, total - width));
  std::string text = table_row(columns, headings, widths);
  for (const auto& row : rows) text += table_row(columns, row, widths);
  return text;
}

}  // namespace delf
