// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "tools/results/result_folder.hpp"

namespace delf {

/// The words for a figure: what it shows, what is found in it, and its numbers as a table in HTML.
struct FigureCaption {
  std::string title, finding, table;
};
/// By the name of the figure. Findings come from the files of the folder; where one is missing there is none.
FigureCaption caption_of(const ResultFolder&, const std::string& figure);

/// A table of text in the folder, at most so many rows of it, evenly spread; empty where it is not there.
std::string csv_table(const ResultFolder&, const std::string& file, std::size_t most);

}  // namespace delf
