// SPDX-License-Identifier: MIT
#include "tools/figures/energy_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/figures/figure_style.hpp"
#include "tools/figures/gnuplot.hpp"
#include "tools/files/text_file.hpp"

namespace delf {

std::string energy_figure(const FigureSource& source, const std::filesystem::path& scratch) {
  const auto& intervals = source.energy_errors.intervals();
  if (intervals.size() < 2) return {};
  double largest = 0;
  for (const auto& i : intervals) largest = std::max({largest, std::abs(i.least), std::abs(i.most)});

  // An error beyond the energy itself, or ten thousand times as large in the last tenth of the run as in the first, grows
  // through many powers of ten: |E − E₀| on a logarithmic axis. Others have a sign, and a linear axis in units of the power
  // of ten that they have.
  constexpr double decades = 1e4, rounding = 1e-16;
  const std::size_t tenth = std::max<std::size_t>(2, intervals.size() / 10);
  const auto largest_in = [&](std::size_t begin) {
    double most = rounding;
    for (std::size_t n = begin; n < std::min(begin + tenth, intervals.size()); ++n)
      most = std::max({most, -intervals[n].least, intervals[n].most});
    return most;
  };
  const bool grown = largest > 10 || largest_in(intervals.size() - tenth) > decades * largest_in(0);
  const bool round_off = largest < 1e-12;
  const double power = grown ? 0 : largest > 0 ? std::floor(std::log10(largest)) : -16;
  // An interval of more than one row is a band from its least to its largest value.
  const bool is_band = !grown && std::ranges::any_of(intervals, [](const auto& i) { return i.most > i.least; });
  const auto shown = [&](double error) {
    return grown ? std::max(std::abs(error), 1e-17) : error / std::pow(10, power);
  };
  std::string table;
  for (const auto& i : intervals) {
    const double middle = 0.5 * (i.begin + i.end);
    if (grown) table += fmt::format("{} {}\n", middle, shown(std::max(-i.least, i.most)));
    else table += fmt::format("{} {} {}\n", middle, shown(i.least), shown(i.most));
  }
  write_text_file(scratch / "energy", table);

  const std::string axis = grown         ? "set logscale y\nset format y '10^{%T}'\n"
                           : largest > 0 ? "set xzeroaxis lc rgb '#999999' lt 1 lw 1\n"
                                         : "set yrange [-1:1]\n";
  const std::string label =
      grown ? "|E − E_0| / |E_0|" : fmt::format("(E − E_0) / |E_0|   in units of 10^{{{}}}", power);
  return figure_title(fmt::format("{}: the energy error{}", source.scene, round_off ? " is round-off" : ""),
                      fmt::format("{}, {}{}", source.theory, source.scheme,
                                  is_band ? "; least to largest of " + source.energy_rows : "")) +
         fmt::format(
             "if (titles) set label 104 {} at screen 0.03,0.862 left font ',9' textcolor rgb '#666666' noenhanced\n",
             gnuplot_quoted("E = " + source.energy)) +
         fmt::format(
             "set lmargin at screen {}\nset rmargin at screen 0.965\n"
             "set bmargin at screen 0.12\nset tmargin at screen (titles ? 0.825 : top)\n"
             "set grid lc rgb '#e4e4e4' lt 1 lw 0.7\n{}"
             "set xlabel 'time t'\n"
             "set label 103 '{}' at screen 0.025,0.4875 center rotate textcolor rgb '#333333'\n"
             "set xrange [{}:{}]\nplot {}'energy' using 1:2 with lines lw 1.3 lc rgb '{}'\n",
             grown ? 0.13 : 0.105, axis, label, intervals.front().begin, intervals.back().end,
             is_band ? fmt::format("'energy' using 1:2:3 with filledcurves lc rgb '{0}' fs solid 0.5 noborder, "
                                   "'energy' using 1:3 with lines lw 1.3 lc rgb '{0}', ",
                                   line_colour)
                     : std::string(),
             line_colour);
}

}  // namespace delf
