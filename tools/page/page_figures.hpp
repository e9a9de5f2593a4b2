// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "tools/results/result_folder.hpp"

namespace delf {

/// A figure of a folder as the source of an image: a data URL, or nothing where it is too large, and the file for a link.
struct PageFigure {
  std::string name, source, file;
  std::string film = {};  ///< of which it is a frame, in the folder: film.mp4
};
/// The figures of all folders, in at most so many bytes together: SVG where there is room, else PNG, and the largest of
/// all are left out.
std::vector<std::vector<PageFigure>> page_figures(const std::vector<ResultFolder>&, std::size_t most_bytes);

/// A file as a data URL, for SVG as text and for others in base64.
std::string data_url(const std::string& type, const std::string& bytes);

}  // namespace delf
