// SPDX-License-Identifier: MIT
#include "tools/figures/figure_style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/figures/gnuplot.hpp"

namespace delf {

namespace {

// viridis, and the blue-white-red of ColorBrewer
constexpr auto even = "'#440154','#472d7b','#3b528b','#2c728e','#21918c','#28ae80','#5ec962','#addc30','#fde725'";
constexpr auto about_zero = "'#053061','#2166ac','#4393c3','#92c5de','#f7f7f7','#f4a582','#d6604d','#b2182b','#67001f'";

constexpr auto style = R"(
set encoding utf8
set minussign
set border 3 lc rgb '#444444' lw 1
set tics nomirror out scale 0.5 textcolor rgb '#333333'
set xlabel textcolor rgb '#333333'
set ylabel textcolor rgb '#333333'
set format x '%h'
set format y '%h'
set format cb '%h'
unset key
)";

}  // namespace

ColourScale colour_scale(std::span<const double> values) {
  std::vector<double> sorted;
  for (const double v : values)
    if (std::isfinite(v)) sorted.push_back(v);
  if (sorted.empty()) return {-1, 1, true};
  std::sort(sorted.begin(), sorted.end());
  const auto quantile = [&](double q) {
    return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
  };
  double least = sorted.front(), most = sorted.back();
  const double low = quantile(0.005), high = quantile(0.995);
  if (most - least > 3 * (high - low) && high > low) least = low, most = high;
  if (most - least <= 1e-9 * std::max(std::abs(least), std::abs(most)) || most == least) {
    const double middle = 0.5 * (least + most), half = std::max(0.5 * std::abs(middle), 1e-3);
    return {middle - half, middle + half, false};
  }
  const bool swings = least < 0 && most > 0 && std::min(-least, most) > 0.5 * std::max(-least, most);
  const double farthest = std::max(-least, most);
  return swings ? ColourScale{-farthest, farthest, true} : ColourScale{least, most, false};
}

std::string gnuplot_colours(const ColourScale& scale) {
  return fmt::format("array colours = [{}]\nset palette defined (", scale.swings ? about_zero : even) +
         "0 colours[1], 1 colours[2], 2 colours[3], 3 colours[4], 4 colours[5], 5 colours[6], 6 colours[7], "
         "7 colours[8], 8 colours[9])\n" +
         fmt::format("set cbrange [{}:{}]\n", scale.least, scale.most);
}

double nice_step(double range, int most) {
  const double power = std::pow(10, std::floor(std::log10(range / most)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (range / (factor * power) <= most) return factor * power;
  return 10 * power;
}

std::string component_colour(std::size_t component) {
  constexpr const char* colours[] = {line_colour, "#d95f02", "#1b9e77", "#7570b3", "#e7298a", "#666666"};
  return colours[component % std::size(colours)];
}

std::string figure_script(const std::string& name, const std::string& body) {
  std::string script;
  script += fmt::format(
      "reset\nset terminal pngcairo size 1800,1200 font 'DejaVu Sans,12' fontscale 2.1 linewidth 2.2\n"
      "set output '{}.png'\n",
      name);
  script += style + body + "unset output\n";
  script += fmt::format(
      "reset\nset terminal svg size 900,600 font 'sans-serif,12' fontscale 1.2 linewidth 1.1 background '#ffffff'\n"
      "set output '{}.svg'\n",
      name);
  script += style + body + "unset output\n";
  return script;
}

std::string figure_title(const std::string& title, const std::string& subtitle) {
  return fmt::format(
      "set label 101 {} at screen 0.03,0.955 left font ',16' textcolor rgb '#111111' noenhanced\n"
      "set label 102 {} at screen 0.03,0.905 left font ',11' textcolor rgb '#666666' noenhanced\n",
      gnuplot_quoted(title), gnuplot_quoted(subtitle));
}

}  // namespace delf
