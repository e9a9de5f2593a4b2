// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "tools/film/film_rows.hpp"

namespace delf {

/// The sides of a panel, as parts of a frame of these pixels.
struct Panel {
  double left, right, bottom, top;
};
inline constexpr int frame_width = 1280, frame_height = 720;

/// The main panel of a film. Its axes are the same in all frames.
struct FilmView {
  std::string about;  ///< what it shows, in words
  /// Writes the data of a frame into `scratch`, and gives the gnuplot commands that draw it. Margins are those of the panel.
  std::function<std::string(std::size_t frame, const std::filesystem::path& scratch)> draw;
};

/// The view of rows: curves over a line, a map of a plane or a surface, an orbit of two or three coordinates, the phase
/// portrait of one whose momenta are recorded, else coordinates over time. Data that all frames share go to `scratch`.
FilmView film_view(const FilmRows&, const Panel&, const std::filesystem::path& scratch);

}  // namespace delf
