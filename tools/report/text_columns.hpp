// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace delf {

/// Columns that UTF-8 text takes on a terminal, one for each code point.
std::size_t columns_of(std::string_view text);
/// Text broken at blanks into lines of at most `width` columns; a longer word is broken where it must be.
std::vector<std::string> wrapped(std::string_view text, std::size_t width);
/// Text that ends in … if it would be wider.
std::string shortened(std::string_view text, std::size_t width);

/// A column of a table.
struct TextColumn {
  std::string heading;
  bool right = false;      ///< aligned to the right, as numbers are
  std::size_t widest = 0;  ///< wrapped beyond; 0: never
  bool rest = false;       ///< wrapped where the line would be wider than the table may be
};
/// A table with its headings, every line indented by two and at most `width` columns wide, if the column `rest` gives
/// enough; each row has a text for each column.
std::string text_table(const std::vector<TextColumn>&, const std::vector<std::vector<std::string>>& rows,
                       std::size_t width);

}  // namespace delf
