// SPDX-License-Identifier: MIT
#include "tools/figures/waveforms_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/figures/figure_style.hpp"
#include "tools/scene/text_file.hpp"

namespace delf {

namespace {

constexpr int most_panels = 6, columns = 3;

std::vector<int> chosen_frames(const FigureSource& source) {
  const Film& film = source.film;
  std::vector<double> times = source.times;
  const int tame = tame_frames(source), panels = std::min(tame, most_panels);
  if (times.empty())
    for (int p = 0; p < panels; ++p)
      times.push_back(film.time(0) + (film.time(tame - 1) - film.time(0)) * p / std::max(1, panels - 1));
  std::vector<int> frames;
  for (const double t : times) {
    int nearest = 0;
    for (int f = 1; f < film.frames(); ++f)
      if (std::abs(film.time(f) - t) < std::abs(film.time(nearest) - t)) nearest = f;
    frames.push_back(nearest);
  }
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  if (frames.size() > most_panels) frames.resize(most_panels);
  return frames;
}

double mean(std::span<const double> row) {
  return std::accumulate(row.begin(), row.end(), 0.0) / static_cast<double>(row.size());
}

}  // namespace

std::string waveforms_figure(const FigureSource& source, const std::filesystem::path& scratch) {
  if (source.film.frames() == 0 || source.lattice.space() == Space::point) return {};
  const auto frames = chosen_frames(source);
  const auto space = drawn_space(source);
  const int panels = static_cast<int>(frames.size());

  // An angle grows or falls as solitons pass: multiples of 2π are subtracted from the whole row, never site by site.
  std::string table;
  std::vector<double> shown;
  std::vector<std::vector<double>> curves;  // of each component, in all panels
  bool turned = false;
  std::vector<std::size_t> components;
  for (std::size_t c = 0; c < source.film.components(); ++c)
    if (c != source.names.drawn_mesh()) components.push_back(c);
  curves.resize(components.size());
  for (const int f : frames) {
    const auto nodes = source.names.drawn_mesh() ? drawn_sites(source, f, *source.names.drawn_mesh()) : space;
    for (std::size_t which = 0; which < components.size(); ++which) {
      const std::size_t c = components[which];
      const auto row = drawn_sites(source, f, c);
      const double drift = mean(row) - mean(drawn_sites(source, 0, c));
      const double turns = source.angle && std::isfinite(drift) ? std::round(drift) : 0;
      turned = turned || turns != 0;
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        shown.push_back(row[i] - turns);
        curves[which].push_back(shown.back());
        table += fmt::format("{} {}\n", nodes[i], shown.back());
      }
      table += "\n\n";
    }
  }
  write_text_file(scratch / "waveforms", table);

  const ColourScale scale = colour_scale(shown);
  const double room = 0.06 * (scale.most - scale.least);
  const int rows = (panels + columns - 1) / columns;
  std::string body =
      figure_title(
          fmt::format("{}: waveforms", source.scene),
          fmt::format("{}, {}{}", source.theory, source.scheme, turned ? "; multiples of 2π are subtracted" : "")) +
      fmt::format(
          "set multiplot layout {},{} margins screen 0.105,0.97,0.125,(top-0.035) spacing screen 0.03,0.085\n"
          "set grid lc rgb '#e4e4e4' lt 1 lw 0.7\nset xrange [{}:{}]\nset yrange [{}:{}]\nset xtics {}\n",
          rows, std::min(columns, panels), space.front(), space.back(), scale.least - room, scale.most + room,
          nice_step(space.back() - space.front(), panels > 1 ? 5 : 10));
  for (int p = 0; p < panels; ++p) {
    const bool left = p % columns == 0, bottom = p + columns >= panels;
    body += fmt::format("set format y '{}'\nset format x '{}'\nset ylabel '{}'\nset xlabel '{}'\n", left ? "%h" : "",
                        bottom ? "%h" : "",
                        left ? (components.size() > 1 ? (source.angle ? "fields / 2π" : "fields")
                                : source.angle        ? "φ / 2π"
                                                      : "φ")
                             : "",
                        bottom ? "space x" : "");
    body += fmt::format("set label 1 't = {:.4g}' at graph 0,1 left offset 0,0.7 textcolor rgb '#333333'\n",
                        source.film.time(frames[static_cast<std::size_t>(p)]));
    if (p == 0)
      body += key_of_curves(
          components.size(), [&](std::size_t c) { return source.names.drawn()[components[c]]; }, curves);
    const int first = p * static_cast<int>(components.size());
    for (std::size_t c = 0; c < components.size(); ++c)
      body += fmt::format("{} 'waveforms' index {} using 1:2 with {} lw 1.6 lc rgb '{}'", c == 0 ? "plot" : ",",
                          first + static_cast<int>(c), source.names.drawn_mesh() ? "linespoints pt 7 ps 0.4" : "lines",
                          component_colour(c));
    body += "\nunset label\n";
  }
  return body + "unset multiplot\n";
}

}  // namespace delf
