// SPDX-License-Identifier: MIT
#include "tools/energy_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/figure_style.hpp"
#include "tools/text_file.hpp"

namespace delf {

std::string energy_figure(const FigureSource& source, const std::filesystem::path& scratch) {
  const auto& intervals = source.energy_errors.intervals();
  if (intervals.size() < 2) return {};
  double largest = 0;
  for (const auto& i : intervals) largest = std::max({largest, std::abs(i.least), std::abs(i.most)});
  if (largest > 1e30) largest = 1e30;
  const double power = largest > 0 ? std::floor(std::log10(largest)) : -16;
  const double unit = std::pow(10, power);

  std::string table;
  for (const auto& i : intervals) {
    const auto shown = [&](double error) { return std::clamp(error, -largest, largest) / unit; };
    table += fmt::format("{} {}\n", i.begin, shown(i.least));
    if (i.most != i.least) table += fmt::format("{} {}\n", i.end, shown(i.most));
  }
  write_text_file(scratch / "energy", table);

  const bool round_off = largest < 1e-12;
  const std::string subtitle = fmt::format("{}, {}", source.theory, source.scheme);
  return figure_title(fmt::format("{}: the energy error{}", source.scene, round_off ? " is round-off" : ""), subtitle) +
         fmt::format("set lmargin at screen 0.105\nset rmargin at screen 0.965\n"
                     "set bmargin at screen 0.12\nset tmargin at screen 0.855\n"
                     "set grid lc rgb '#e4e4e4' lt 1 lw 0.7\nset xzeroaxis lc rgb '#999999' lt 1 lw 1\n"
                     "set xlabel 'time t'\n"
                     "set label 103 '(E − E_0) / |E_0|   in units of 10^{{{}}}' at screen 0.025,0.4875 center rotate "
                     "textcolor rgb '#333333'\n"
                     "set xrange [{}:{}]\n{}plot 'energy' using 1:2 with lines lw 1.3 lc rgb '{}'\n",
                     power, intervals.front().begin, intervals.back().end,
                     largest > 0 ? "" : "set yrange [-1:1]\n", line_colour);
}

}  // namespace delf
