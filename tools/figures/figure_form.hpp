// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

namespace delf {

/// The formats that figures may have; each is the ending of their files, too.
inline const std::vector<std::string> figure_formats{"svg", "png", "pdf"};

/// The form of figures: output.format and output.titles.
struct FigureForm {
  std::vector<std::string> formats{"png", "svg"};
  bool titles = true;  ///< off: for a paper, whose captions say it
};

}  // namespace delf
