// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/figures/figure_style.hpp"
#include "tools/files/text_file.hpp"
#include "tools/verify/verdict_figures.hpp"

namespace delf {

namespace {

// The width of a bin; one that is alone has any.
double bin_width(const std::vector<double>& centres) {
  return centres.size() < 2 ? 1 : (centres.back() - centres.front()) / static_cast<double>(centres.size() - 1);
}

// All of the range, in whole powers of ten: one bad site among thousands is what the map is there to show.
ColourScale scale_of(const std::vector<double>& map) {
  double least = 300, most = -300;
  for (const double v : map)
    if (!std::isnan(v)) least = std::min(least, v), most = std::max(most, v);
  least = std::floor(least);
  return {least, std::max(std::ceil(most), least + 2), false};
}

// A ring about the largest, where it stands out from the rest.
std::string ring(const ResidualMap& map, std::size_t worst, double width) {
  constexpr double far_above = 3;  // powers of ten above the median
  std::vector<double> sorted;
  for (const double v : map.log10)
    if (!std::isnan(v)) sorted.push_back(v);
  std::ranges::nth_element(sorted, sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2));
  if (map.log10[worst] < sorted[sorted.size() / 2] + far_above) return {};
  std::string rings;
  int number = 1;
  for (const auto& [line, colour] : {std::pair{5, "#ffffff"}, {2, "#d62728"}})
    rings += fmt::format(
        "set object {} circle at {},{} size {} front noclip fillstyle empty border lc rgb '{}' lw {}\n", number++,
        map.space[worst % map.space.size()], map.time[worst / map.space.size()], 0.02 * width, colour, line);
  return rings;
}

// On a point there is no space to show: the residual against time.
std::string over_time(const ResidualMap& map, const ColourScale& scale, const char* label,
                      const std::filesystem::path& scratch) {
  std::string table;
  for (std::size_t i = 0; i < map.time.size(); ++i)
    if (!std::isnan(map.log10[i])) table += fmt::format("{} {}\n", map.time[i], map.log10[i]);
  write_text_file(scratch / "residual", table);
  return fmt::format(
      "set rmargin at screen 0.965\nset grid lc rgb '#e4e4e4' lt 1 lw 0.7\nset format y '10^{{%h}}'\n"
      "set ytics {}\nset xlabel 'time t'\nset xrange [{}:{}]\nset yrange [{}:{}]\n"
      "set label 103 'largest {}' at screen 0.025,0.4875 center rotate textcolor rgb '#333333'\n"
      "plot 'residual' using 1:2 with points pt 7 ps (GPVAL_TERM eq 'svg' ? 0.3 : 0.8) lc rgb '{}'\n",
      std::max(1.0, nice_step(scale.most - scale.least, 8)), map.time.front() - bin_width(map.time) / 2,
      map.time.back() + bin_width(map.time) / 2, scale.least - 0.5, scale.most + 0.5, label, line_colour);
}

/// `label`: what is drawn; `title`: after the scene's name.
std::string figure_of(const ResidualMap& given, const char* title, const char* label, const VerdictSource& source,
                      const std::filesystem::path& scratch) {
  ResidualMap map = given;
  const std::size_t rows = map.time.size(), columns = map.space.size();
  if (map.log10.empty() || map.log10.size() != rows * columns) return {};
  if (rows < 2) return {};  // gnuplot refuses an image of one row
  for (double& v : map.log10)
    if (!std::isnan(v)) v = std::clamp(v, std::log10(drawn_zero), 3.0);  // the logarithms of 0 and of infinity
  const auto less = [](double a, double b) { return std::isnan(b) ? false : std::isnan(a) || a < b; };
  const std::size_t worst = std::ranges::max_element(map.log10, less) - map.log10.begin();
  if (std::isnan(map.log10[worst])) return {};
  write_text_file(scratch / "residuals",
                  {reinterpret_cast<const char*>(map.log10.data()), map.log10.size() * sizeof(double)});

  const ColourScale scale = scale_of(map.log10);
  const double dx = bin_width(map.space), dt = bin_width(map.time), width = dx * static_cast<double>(columns);
  const bool finite = std::isfinite(given.log10[worst]) || map.log10[worst] < 0;
  const std::string largest = finite ? fmt::format("{:.2g}", std::pow(10, map.log10[worst])) : "not a finite number";
  const std::string where = fmt::format("t = {:.4g}", map.time[worst / columns]) +
                            (columns > 1 ? fmt::format(", x = {:.4g}", map.space[worst % columns]) : "");
  const std::string head =
      verdict_title(source.scene + title, fmt::format("largest: {} at {}", largest, where), source.scheme) +
      fmt::format("set lmargin at screen {}\nset bmargin at screen 0.12\nset tmargin at screen top\n",
                  columns > 1 ? 0.105 : 0.13);
  if (columns == 1) return head + over_time(map, scale, label, scratch);
  return gnuplot_colours(scale) + head + ring(map, worst, width) +
         fmt::format(
             "set rmargin at screen 0.845\nset xlabel 'space x'\n"
             "set label 103 'time t' at screen 0.025,0.4875 center rotate textcolor rgb '#333333'\n"
             "set label 104 '{}' at screen 0.92,(top+0.017) center textcolor rgb '#333333' noenhanced\n"
             "set border 15\nset object 100 rectangle from graph 0,0 to graph 1,1 behind fc rgb '#dddddd' fs solid "
             "noborder\n"
             "set colorbox user origin screen 0.868,0.12 size screen 0.022,(top-0.145) noborder\n"
             "set format cb '10^{{%h}}'\nset cbtics {} scale 0.3\nset xrange [{}:{}]\nset yrange [{}:{}]\n"
             "plot 'residuals' binary array=({},{}) dx={} dy={} origin=({},{}) format='%double' using 1 with image\n",
             label, std::max(1.0, nice_step(scale.most - scale.least, 8)), map.space.front() - dx / 2,
             map.space.back() + dx / 2, map.time.front() - dt / 2, map.time.back() + dt / 2, columns, rows, dx, dt,
             map.space.front(), map.time.front());
}

}  // namespace

std::string residual_map_figure(const VerdictSource& source, const std::filesystem::path& scratch) {
  return figure_of(source.verdict.map, ": the residual of the equations", "|E| / Σ|terms|", source, scratch);
}

std::string severity_map_figure(const VerdictSource& source, const std::filesystem::path& scratch) {
  return figure_of(source.verdict.severity, ": the residual beside the force of each site", "|E| / max|force|", source,
                   scratch);
}

}  // namespace delf
