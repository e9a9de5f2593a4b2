// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/outcome/findings_json.hpp"

namespace delf {

// The elements of a page. Every function takes plain text and escapes it, but for parameters named `html`.

/// Text as it may be in an element or in a quoted attribute; bytes that are no UTF-8 are replaced.
std::string escaped(std::string_view text);

struct PageTable {
  std::string caption;
  std::vector<std::string> headings;           ///< none: rows are names with values
  std::vector<std::vector<std::string>> rows;  ///< the first cell names the row
};
/// A table that scrolls by itself where the page is narrow; empty without rows.
std::string table(const PageTable&);
/// A table with a row for each object of a list; a column has a heading, and the key of its values.
std::string table_of(const std::string& caption, const std::vector<std::pair<std::string, std::string>>& columns,
                     const std::vector<Json>& list);
std::string paragraph(std::string_view text);
/// Empty without items.
std::string list(const std::vector<std::string>& items);
std::string code_block(std::string_view label, std::string_view text);
std::string details(std::string_view summary, const std::string& html);
/// A part of the page under a heading, which links can lead to.
std::string section(std::string_view id, std::string_view heading, const std::string& html);

/// The whole document: one file without script that loads nothing.
std::string document(std::string_view title, const std::string& html);

}  // namespace delf
