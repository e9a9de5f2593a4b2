// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/figures/figure_style.hpp"
#include "tools/figures/gnuplot.hpp"
#include "tools/files/text_file.hpp"
#include "tools/stability/stability_figures.hpp"

namespace delf {

namespace {

// Whole lines for the first six colours, then dashed ones.
std::string line_of(std::size_t s) {
  return fmt::format("lc rgb '{}' lw 1.6 {}", component_colour(s), s < 6 ? "" : s < 12 ? "dt (10,5)" : "dt (3,4)");
}

// A line and a name, to the right of both plots.
std::string key_entry(std::size_t place, const std::string& name, const std::string& line) {
  const double y = 0.84 - 0.033 * static_cast<double>(place);
  return fmt::format(
      "set arrow from screen 0.72,{} to screen 0.755,{} nohead {}\n"
      "set label {} at screen 0.765,{} left font ',9' textcolor rgb '#333333' noenhanced\n",
      y, y, line, gnuplot_quoted(name), y);
}

// Halves of π, or whole ones.
std::string tics(double farthest) {
  std::string text = "'0' 0";
  const int step = farthest > 2.5 * std::numbers::pi ? 2 : 1;
  for (int n = step; n * std::numbers::pi / 2 <= farthest * 1.001; n += step)
    text += fmt::format(", '{}' {}",
                        n % 2    ? fmt::format("{}π/2", n == 1 ? "" : fmt::to_string(n))
                           : n == 2 ? "π"
                                 : fmt::format("{}π", n / 2),
                        n * std::numbers::pi / 2);
  return text;
}

}  // namespace

std::string dispersion_figure(const StabilityFindings& f, const std::string& scene,
                              const std::filesystem::path& scratch) {
  if (f.dispersion.empty()) return {};
  const double mass = f.dispersion_mass;
  std::string table, above, below, key = key_entry(0, "exact", "lc rgb '#bbbbbb' lw 5");
  double farthest = std::numbers::pi;
  std::vector<std::vector<double>> frequencies(f.dispersion.size());
  for (std::size_t s = 0; s < f.dispersion.size(); ++s) {
    const DispersionCurve& c = f.dispersion[s];
    table += "NaN NaN NaN\n";  // so that no table is empty
    for (const FrequencyPoint& p : c.points) {
      if (!std::isfinite(p.numerical) || !(p.exact > 0)) continue;
      farthest = std::max(farthest, p.wave_number);
      const double error = std::max(std::abs(p.numerical / p.exact - 1), 1e-16);
      table += fmt::format("{} {} {}\n", p.wave_number, p.numerical, error);
      frequencies[s].push_back(p.numerical);
    }
    table += "\n\n";
    above += fmt::format(", 'dispersion' index {} using 1:2 with lines {} notitle", s, line_of(s));
    below += fmt::format("{}'dispersion' index {} using 1:3 with lines {} notitle", s == 0 ? "" : ", ", s, line_of(s));
  }
  // one scheme's frequency may grow without bound where waves are shortest, and would flatten all others
  const double highest = 1.6 * std::sqrt(farthest * farthest + mass * mass);
  const auto on = coinciding(frequencies, highest);
  for (std::size_t s = 0; s < f.dispersion.size(); ++s) {
    key += key_entry(s + 1,
                     f.dispersion[s].scheme + (on[s] < s ? fmt::format(" (on {})", f.dispersion[on[s]].scheme) : ""),
                     line_of(s));
  }
  write_text_file(scratch / "dispersion", table);
  return figure_title(
             scene + ": dispersion of the schemes and of the field equation",
             fmt::format(
                 "klein-gordon, h/k = {:.4g}, mk = {:.4g}; elements of degree p have p nodes in a cell of length k",
                 f.dispersion_courant, mass)) +
         key +
         fmt::format(
             "set multiplot\nset lmargin at screen 0.1\nset rmargin at screen 0.7\nset grid lc rgb '#e4e4e4' lt 1 lw "
             "0.7\n"
             "set samples 400\nset xrange [0:{}]\nset xtics ({})\n"
             "set tmargin at screen top\nset bmargin at screen 0.53\nset ylabel 'ωk'\nset yrange [0:{}]\n"
             "plot sqrt(x*x+{}) with lines lc rgb '#bbbbbb' lw 5 notitle{}\n"
             "unset label\nunset arrow\n"
             "set tmargin at screen 0.46\nset bmargin at screen 0.12\nset logscale y\nset format y '10^{{%T}}'\n"
             "set yrange [1e-10:10]\nset ytics 1e2\nset mytics 1\nset ylabel 'error of ω' offset 1.5,0\n"
             "set xlabel 'wave number qk'\nplot {}\nunset multiplot\n",
             farthest, tics(farthest), highest, mass * mass, above, below);
}

}  // namespace delf
