// SPDX-License-Identifier: MIT
#include "tools/figures/trajectory_figure.hpp"

#include <fmt/format.h>

#include "tools/figures/figure_style.hpp"
#include "tools/scene/text_file.hpp"

namespace delf {

namespace {

// time, and every coordinate
std::string table_of(const FigureSource& source) {
  std::string table;
  for (int f = 0; f < source.film.frames(); ++f) {
    table += fmt::format("{}", source.film.time(f));
    for (std::size_t c = 0; c < source.film.components(); ++c)
      table += fmt::format(" {}", drawn_frame(source, f, c).front());
    table += "\n";
  }
  return table;
}

std::string coordinate(const FigureSource& source, std::size_t component) {
  return source.film.components() == 1 ? "q" : fmt::format("q{}", component + 1);
}

constexpr auto sides = "set lmargin at screen 0.105\nset rmargin at screen 0.965\n";
constexpr auto rest =
    "set bmargin at screen 0.12\nset tmargin at screen 0.855\nset grid lc rgb '#e4e4e4' lt 1 lw 0.7\n";

}  // namespace

std::string trajectory_figure(const FigureSource& source, const std::filesystem::path& scratch) {
  if (source.lattice.space() != Space::point || source.film.frames() < 2) return {};
  write_text_file(scratch / "trajectory", table_of(source));
  const std::size_t d = source.film.components();
  std::string body =
      figure_title(fmt::format("{}: the coordinate{} over time", source.scene, d == 1 ? "" : "s"),
                   fmt::format("{}, {}", source.theory, source.scheme)) +
      sides + rest +
      fmt::format(
          "set xlabel 'time t'\nset xrange [{}:{}]\nset label 103 '{}{}' at screen 0.025,0.4875 center rotate "
          "textcolor rgb '#333333'\n",
          source.film.time(0), source.film.time(source.film.frames() - 1), d == 1 ? "q" : "coordinates",
          source.angle ? " / 2π" : "");
  for (std::size_t c = 0; d > 1 && c < d; ++c)
    body += fmt::format("set label {} '{}' at screen {},0.905 right textcolor rgb '{}'\n", 110 + c,
                        coordinate(source, c), 0.965 - 0.05 * static_cast<double>(d - 1 - c), component_colour(c));
  for (std::size_t c = 0; c < d; ++c)
    body += fmt::format("{} 'trajectory' using 1:{} with lines lw 1.4 lc rgb '{}'", c == 0 ? "plot" : ",", c + 2,
                        component_colour(c));
  return body + "\n";
}

std::string orbit_figure(const FigureSource& source, const std::filesystem::path& scratch) {
  if (source.lattice.space() != Space::point || source.film.frames() < 2 || source.film.components() != 2) return {};
  write_text_file(scratch / "orbit", table_of(source));
  return figure_title(fmt::format("{}: the orbit", source.scene), fmt::format("{}, {}", source.theory, source.scheme)) +
         rest +
         fmt::format(
             "set xlabel 'q1'\nset ylabel 'q2'\nset size ratio -1\nplot 'orbit' using 2:3 with lines lw 1.2 lc rgb "
             "'{}'\n",
             line_colour);
}

}  // namespace delf
