// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/figures/figure_style.hpp"
#include "tools/figures/gnuplot.hpp"
#include "tools/files/text_file.hpp"
#include "tools/report/text_columns.hpp"
#include "tools/stability/stability_figures.hpp"

namespace delf {

namespace {

constexpr const char* colours[] = {"#9fc8e6", "#f2c14e", "#c0392b", "#8f8f8f"};  // in the order of Growth
constexpr const char* words[] = {"bounded", "grows linearly", "grows exponentially", "refused"};

double step_of(const std::vector<double>& v) { return (v.back() - v.front()) / static_cast<double>(v.size() - 1); }

// Rectangles of one verdict each: a table of x, log10 y, number of the verdict.
std::string cells_of_map(const StabilityMap& m) {
  std::string text;
  for (std::size_t j = 0; j < m.mass_steps.size(); ++j)
    for (std::size_t i = 0; i < m.courants.size(); ++i)
      text += fmt::format("{} {} {}\n", m.courants[i], std::log10(m.mass_steps[j]),
                          static_cast<int>(m.grows[j * m.courants.size() + i]));
  return text;
}

std::string edges(const StabilityMap& m) {
  std::string text = "NaN NaN\n";  // so that no table is empty
  for (std::size_t j = 0; j < m.edge_masses.size(); ++j)
    for (const double courant : m.edges[j]) text += fmt::format("{} {}\n", courant, std::log10(m.edge_masses[j]));
  return text;
}

std::string legend() {
  std::string text;
  double x = 0.035;
  for (std::size_t g = 0; g < std::size(colours); ++g) {
    text += fmt::format(
        "set object {} rectangle from screen {},0.018 to screen {},0.042 fc rgb '{}' fs solid border lc rgb '#444444'\n"
        "set label {} '{}' at screen {},0.03 left font ',10' textcolor rgb '#333333'\n",
        200 + g, x, x + 0.022, colours[g], 200 + g, words[g], x + 0.029);
    x += 0.055 + 0.0098 * static_cast<double>(columns_of(words[g]));
  }
  return text +
         fmt::format(
             "set label 210 '●  the ends of stability by theory' at screen {},0.03 left font ',10' textcolor rgb "
             "'#111111'\n",
             x);
}

}  // namespace

std::string stability_map_figure(const StabilityFindings& f, const std::string& scene, std::size_t part,
                                 const std::filesystem::path& scratch) {
  const std::size_t first = part * maps_in_a_figure, count = std::min(maps_in_a_figure, f.maps.size() - first);
  if (count == 0) return {};
  const std::size_t columns = count == 1 ? 1 : count <= 4 ? 2 : 3, rows = (count + columns - 1) / columns;
  std::string text =
      figure_title(
          scene + ": what noise does, and the limits of linear theory",
          "klein-gordon, 400 steps of noise on 33 sites, or N: ghosts of even N, and narrow bands of waves, do "
          "not show") +
      legend() + "set multiplot\nset border 15\n";
  for (std::size_t p = 0; p < count; ++p) {
    const StabilityMap& m = f.maps[first + p];
    if (m.courants.size() < 2 || m.mass_steps.size() < 2) continue;
    write_text_file(scratch / fmt::format("cells-{}-{}", part, p), cells_of_map(m));
    write_text_file(scratch / fmt::format("edges-{}-{}", part, p), edges(m));
    std::vector<double> decades;
    for (const double mass : m.mass_steps) decades.push_back(std::log10(mass));
    const double dx = step_of(m.courants), dy = step_of(decades);
    const double width = 0.92 / static_cast<double>(columns), height = 0.74 / static_cast<double>(rows);
    const std::size_t column = p % columns, row = p / columns;
    const double left = 0.075 + width * static_cast<double>(column);
    const double top = 0.85 - height * static_cast<double>(row);
    const bool lowest = p + columns >= count;
    std::string tics;
    for (const double mass : {0.01, 0.1, 1.0, 10.0, 100.0})
      tics += fmt::format("{}'{:g}' {}", tics.empty() ? "" : ", ", mass, std::log10(mass));
    std::string palette;
    for (std::size_t g = 0; g < std::size(colours); ++g)
      palette += fmt::format("{}{} '{}'", g == 0 ? "" : ", ", g, colours[g]);
    text += fmt::format(
        "set lmargin at screen {}\nset rmargin at screen {}\nset tmargin at screen {}\nset bmargin at screen {}\n"
        "set label 105 {} at graph 0,1 left offset 0,0.55 font ',11' textcolor rgb '#111111' noenhanced\n"
        "set xrange [{}:{}]\nset yrange [{}:{}]\nset ytics ({})\nset xtics 1\nset format x '{}'\n"
        "set xlabel '{}' offset 0,0.4\nset ylabel '{}' offset 1.2,0\n"
        "set palette defined ({})\nset cbrange [0:3]\nunset colorbox\n"
        "plot 'cells-{}-{}' using 1:2:($1-{}):($1+{}):($2-{}):($2+{}):3 with boxxyerror fs solid noborder lc palette, "
        "'edges-{}-{}' using 1:2 with points pt 7 ps (GPVAL_TERM eq 'svg' ? 0.22 : 0.6) lc rgb '#111111'\n"
        "unset object\nunset label\n",
        left, left + width - 0.055, top, top - height + 0.075,
        gnuplot_quoted(m.scheme + (m.sites % 2 == 0 ? fmt::format(",  N = {}", m.sites) : "")),
        m.courants.front() - dx / 2, m.courants.back() + dx / 2, decades.front() - dy / 2, decades.back() + dy / 2,
        tics, lowest ? "%h" : "", lowest ? "Courant number h/k" : "", column == 0 ? "mh" : "", palette, part, p, dx / 2,
        dx / 2, dy / 2, dy / 2, part, p);
  }
  return text + "unset multiplot\n";
}

}  // namespace delf
