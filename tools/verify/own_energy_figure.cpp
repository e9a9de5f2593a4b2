// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/figures/figure_style.hpp"
#include "tools/figures/gnuplot.hpp"
#include "tools/files/text_file.hpp"
#include "tools/verify/verdict_figures.hpp"

namespace delf {

std::string own_energy_figure(const VerdictSource& source, const std::filesystem::path& scratch) {
  const EnergyHistory& energy = source.verdict.energy;
  constexpr std::size_t most_points = 2000;
  const std::size_t n = energy.value.size(), stride = std::max<std::size_t>(1, 2 * n / most_points);
  if (n < 3 || !std::ranges::all_of(energy.value, [](double E) { return std::isfinite(E); })) return {};
  const double first = energy.value[0], scale = first == 0 ? 1 : std::abs(first);
  double largest = 0;
  for (const double E : energy.value) largest = std::max(largest, std::abs(E - first) / scale);
  const double power = largest > 0 ? std::floor(std::log10(largest)) : -16;
  // of many rows the least and the most of each so many
  std::string table;
  for (std::size_t j = 0; j < n; j += stride) {
    const auto begin = energy.value.begin() + static_cast<std::ptrdiff_t>(j);
    const auto [least, greatest] =
        std::minmax_element(begin, begin + static_cast<std::ptrdiff_t>(std::min(stride, n - j)));
    for (const double E : {*least, *greatest})
      table += fmt::format("{} {}\n", energy.time[j], (E - first) / scale / std::pow(10, power));
  }
  write_text_file(scratch / "energy", table);
  return verdict_title(source.scene + ": " + energy.name, fmt::format("largest change {:.2g}", largest),
                       source.scheme) +
         fmt::format(
             "set lmargin at screen 0.105\nset rmargin at screen 0.965\nset bmargin at screen 0.12\n"
             "set tmargin at screen top\nset grid lc rgb '#e4e4e4' lt 1 lw 0.7\nset xlabel 'time t'\n{}"
             "set label 103 '(E − E_0) / |E_0|   in units of 10^{{{}}}' at screen 0.025,0.4875 center rotate textcolor "
             "rgb '#333333'\nset xrange [{}:{}]\nplot 'energy' using 1:2 with lines lw 1.3 lc rgb '{}'\n",
             largest > 0 ? "set xzeroaxis lc rgb '#999999' lt 1 lw 1\n" : "set yrange [-1:1]\n", power,
             energy.time.front(), energy.time.back(), line_colour);
}

}  // namespace delf
