// SPDX-License-Identifier: MIT
#include "tools/figures/trajectory_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "tools/figures/figure_style.hpp"
#include "tools/figures/gnuplot.hpp"
#include "tools/files/text_file.hpp"

namespace delf {

namespace {

// time, and every coordinate
std::string table_of(const FigureSource& source) {
  std::string table;
  for (int f = 0; f < source.thinned.frames(); ++f) {
    table += fmt::format("{}", source.thinned.time(f));
    for (std::size_t c = 0; c < source.thinned.components(); ++c)
      table += fmt::format(" {}", drawn_frame(source, f, c).front());
    table += "\n";
  }
  return table;
}

constexpr std::size_t in_a_panel = line_colours, most_trajectories = 4;

// More coordinates than colours: panels of some, one below the other, each with the names of its curves.
std::string panels(const FigureSource& source, std::size_t d) {
  const std::size_t count = std::min(most_trajectories, (d + in_a_panel - 1) / in_a_panel);
  std::string body = fmt::format(
      "set multiplot layout {},1 margins screen 0.105,0.965,0.12,(top-0.025) spacing screen 0,0.06\n"
      "set format x ''\nunset xlabel\n",
      count);
  for (std::size_t p = 0; p < count; ++p) {
    const std::size_t first = p * in_a_panel, last = std::min(d, first + in_a_panel);
    double least = 1e300, most = -1e300;
    for (std::size_t c = first; c < last; ++c)
      for (int f = 0; f < source.thinned.frames(); ++f) {
        const double q = drawn_frame(source, f, c).front();
        least = std::min(least, q), most = std::max(most, q);
      }
    if (most > least) body += fmt::format("set ytics {}\n", nice_step(most - least, 5));
    for (std::size_t c = first; c < last; ++c)
      body +=
          fmt::format("set label {} {} at graph {},1.0 right offset 0,0.55 font ',10' textcolor rgb '{}' noenhanced\n",
                      110 + c, gnuplot_quoted(coordinate_name(source, c)), 1 - 0.07 * static_cast<double>(last - 1 - c),
                      component_colour(c));
    if (p + 1 == count) body += "set format x '%h'\nset xlabel 'time t'\n";
    for (std::size_t c = first; c < last; ++c)
      body += fmt::format("{} 'trajectory' using 1:{} with lines lw 1.4 lc rgb '{}'", c == first ? "plot" : ",", c + 2,
                          component_colour(c));
    body += "\nunset label\n";
  }
  return body + "unset multiplot\n";
}

constexpr auto sides = "set lmargin at screen 0.105\nset rmargin at screen 0.965\n";
constexpr auto rest = "set bmargin at screen 0.12\nset tmargin at screen top\nset grid lc rgb '#e4e4e4' lt 1 lw 0.7\n";

// Both axes of an orbit have one unit: a narrow one has room for few numbers.
std::string tics(const FigureSource& source) {
  double least[2] = {1e300, 1e300}, most[2] = {-1e300, -1e300};
  for (int f = 0; f < source.thinned.frames(); ++f)
    for (const std::size_t c : {0UL, 1UL}) {
      const double q = drawn_frame(source, f, c).front();
      least[c] = std::min(least[c], q), most[c] = std::max(most[c], q);
    }
  constexpr double wide = 800, high = 440, number_wide = 60, number_high = 30;  // of 900 x 600
  const double dx = most[0] - least[0], dy = most[1] - least[1];
  if (!(dx > 0) || !(dy > 0)) return {};
  const double unit = std::min(wide / dx, high / dy);
  const auto step = [&](double range, double each) {
    return nice_step(range, std::clamp(static_cast<int>(range * unit / each), 1, 10));
  };
  return fmt::format("set xtics {}\nset ytics {}\n", step(dx, number_wide), step(dy, number_high));
}

}  // namespace

std::string coordinate_name(const FigureSource& source, std::size_t component) {
  const std::string name = source.names.drawn()[component];
  if (!name.starts_with("phi")) return name;
  return source.thinned.components() == 1 ? "q" : fmt::format("q{}", component + 1);
}

std::string trajectory_figure(const FigureSource& source, const std::filesystem::path& scratch) {
  if (source.lattice.space() != Space::point || source.thinned.frames() < 2) return {};
  write_text_file(scratch / "trajectory", table_of(source));
  const std::size_t d = source.thinned.components();
  std::string body =
      figure_title(fmt::format("{}: the coordinate{} over time", source.scene, d == 1 ? "" : "s"),
                   fmt::format("{}{}", subtitle(source),
                               d > most_trajectories * in_a_panel
                                   ? fmt::format("; the first {} of {}", most_trajectories * in_a_panel, d)
                                   : "")) +
      sides + rest +
      fmt::format(
          "set xlabel 'time t'\nset xrange [{}:{}]\nset label 103 '{}{}' at screen 0.025,0.4875 center rotate "
          "textcolor rgb '#333333'\n",
          source.thinned.time(0), source.thinned.time(source.thinned.frames() - 1),
          d == 1 ? coordinate_name(source, 0) : "coordinates", source.angle ? " / 2π" : "");
  if (d > in_a_panel) return body + panels(source, d);
  std::vector<std::vector<double>> curves(d);
  for (std::size_t c = 0; c < d; ++c)
    for (int f = 0; f < source.thinned.frames(); ++f) curves[c].push_back(drawn_frame(source, f, c).front());
  body += robust_range("y", curves) + key_of_curves(
                                          d, [&](std::size_t c) { return coordinate_name(source, c); }, curves);
  for (std::size_t c = 0; c < d; ++c)
    body += fmt::format("{} 'trajectory' using 1:{} with lines lw 1.4 lc rgb '{}'", c == 0 ? "plot" : ",", c + 2,
                        component_colour(c));
  return body + "\n";
}

std::string orbit_figure(const FigureSource& source, const std::filesystem::path& scratch) {
  if (source.lattice.space() != Space::point || source.thinned.frames() < 2 || source.thinned.components() != 2)
    return {};
  write_text_file(scratch / "orbit", table_of(source));
  return figure_title(fmt::format("{}: the orbit", source.scene), subtitle(source)) + rest +
         fmt::format(
             "set xlabel {} noenhanced\nset ylabel {} noenhanced\nset size ratio -1\n{}plot 'orbit' using 2:3 with "
             "lines "
             "lw 1.2 lc rgb '{}'\n",
             gnuplot_quoted(coordinate_name(source, 0)), gnuplot_quoted(coordinate_name(source, 1)), tics(source),
             line_colour);
}

}  // namespace delf
