// SPDX-License-Identifier: MIT
#include "tools/figures/phase_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/figures/figure_style.hpp"
#include "tools/figures/gnuplot.hpp"
#include "tools/figures/trajectory_figure.hpp"
#include "tools/files/text_file.hpp"

namespace delf {

namespace {

// p of q, or of q1 p1.
std::string momentum_name(const FigureSource& source, std::size_t component) {
  const std::string name = coordinate_name(source, component);
  return name.starts_with("q") ? "p" + name.substr(1) : "p of " + name;
}

}  // namespace

std::string phase_figure(const FigureSource& source, const std::filesystem::path& scratch) {
  constexpr std::size_t most_panels = 6;
  if (source.lattice.space() != Space::point || !source.momenta || source.thinned.frames() < 2) return {};
  const std::size_t d = source.thinned.components(), panels = std::min(d, most_panels);
  std::vector<std::vector<double>> q(panels), p(panels);
  bool is_known = false;
  for (int f = 0; f < source.thinned.frames(); ++f)
    for (std::size_t c = 0; c < panels; ++c) {
      q[c].push_back(drawn_sites(source, f, c)[0]), p[c].push_back(source.momenta->frame(f)[c]);
      is_known = is_known || std::isfinite(p[c].back());
    }
  if (!is_known) return {};
  const std::size_t columns = std::min<std::size_t>(panels, 3), rows = (panels + columns - 1) / columns;
  constexpr double between = 0.1;
  const double width = (0.97 - 0.105 - between * static_cast<double>(columns - 1)) / static_cast<double>(columns);
  std::string body =
      figure_title(fmt::format("{}: phase portrait{}, momentum over coordinate", source.scene, d == 1 ? "" : "s"),
                   fmt::format("{}{}", subtitle(source),
                               d > most_panels ? fmt::format("; the first {} of {}", most_panels, d) : "")) +
      fmt::format(
          "set multiplot layout {},{} margins screen 0.105,0.97,0.12,(top-0.01) spacing screen {},0.15\n"
          "set grid lc rgb '#e4e4e4' lt 1 lw 0.7\n",
          rows, columns, between);
  std::string table;
  for (std::size_t c = 0; c < panels; ++c) {
    // Momenta that are small or large are in units of a power of ten.
    double largest = 0;
    for (const double value : p[c])
      if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
    const double power = largest > 0 && (largest < 1e-2 || largest >= 1e4) ? std::floor(std::log10(largest)) : 0;
    for (double& value : p[c]) value /= std::pow(10, power);
    for (std::size_t f = 0; f < q[c].size(); ++f) table += fmt::format("{} {}\n", q[c][f], p[c][f]);
    table += "\n\n";
    const auto axis = [&](const char* which, const std::vector<double>& values) {
      const ColourScale scale = colour_scale(values);
      const double step = nice_step(scale.most - scale.least, 4), low = step * std::floor(scale.least / step),
                   high = step * std::ceil(scale.most / step);
      return fmt::format("set {}range [{}:{}]\n", which, low, high) +
             (*which == 'x' ? panel_tics(low, high, width) : fmt::format("set ytics {}\n", step));
    };
    // frames farther apart than the motion lasts are points of it
    body +=
        axis("x", q[c]) + axis("y", p[c]) +
        fmt::format(
            "set xlabel {} noenhanced\nset ylabel {} offset 1,0\nplot 'phase' index {} using 1:2 with {} lc rgb '{}'\n",
            gnuplot_quoted(coordinate_name(source, c) + (source.angle ? " / 2π" : "")),
            gnuplot_quoted(momentum_name(source, c) +
                           (power == 0 ? "" : fmt::format("   in units of 10^{{{}}}", power))),
            c, source.thinned.is_aliased() ? "points pt 7 ps 0.25" : "lines lw 1.2", line_colour) +
        "unset label\n";  // the title is drawn once
  }
  write_text_file(scratch / "phase", table);
  return body + "unset multiplot\n";
}

}  // namespace delf
