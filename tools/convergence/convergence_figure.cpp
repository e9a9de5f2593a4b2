// SPDX-License-Identifier: MIT
#include "tools/convergence/convergence_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/figures/drawing.hpp"
#include "tools/figures/figure_style.hpp"
#include "tools/figures/gnuplot.hpp"
#include "tools/files/text_file.hpp"

namespace delf {
namespace {

struct Curve {
  const char* name;
  double ConvergenceLevel::*norm;
};

bool is_drawn(double error) { return std::isfinite(error) && error > 0; }

std::string figure(const Scene& scene, const std::string& label, const ConvergenceTable& table,
                   const std::vector<double>& orders, const std::filesystem::path& scratch) {
  const bool point = scene.problem.lattice.space() == Space::point;
  const auto place = [&](const ConvergenceLevel& level) { return point ? 1 / level.time_step : level.sites; };
  // The norm that the order is of comes first, in the dark colour.
  std::vector<Curve> curves{{"maximum norm", &ConvergenceLevel::linf}, {"L_2 norm", &ConvergenceLevel::l2}};
  if (table.norm == &ConvergenceLevel::l2) std::swap(curves[0], curves[1]);
  std::vector<const ConvergenceLevel*> levels;
  for (const ConvergenceLevel& level : table.levels)
    if (is_drawn(level.*table.norm) && std::isfinite(place(level))) levels.push_back(&level);
  if (levels.size() < 2) return {};

  std::string data, plots, tics;
  double least = 1e300, most = 0;
  int block = 0;
  const auto end_curve = [&](const std::string& style) {
    data += "\n\n";
    plots += fmt::format("{}'errors' index {} using 1:2 with {}", plots.empty() ? "" : ", \\\n  ", block++, style);
  };
  for (std::size_t c = 0; c < curves.size(); ++c) {
    for (const ConvergenceLevel* level : levels) {
      const double error = level->*curves[c].norm;
      if (!is_drawn(error)) continue;
      data += fmt::format("{} {}\n", place(*level), error);
      least = std::min(least, error), most = std::max(most, error);
    }
    end_curve(fmt::format("linespoints lw 1.6 pt 7 ps (GPVAL_TERM eq 'svg' ? 0.6 : 1.4) lc rgb '{}' title '{}'",
                          component_colour(c), curves[c].name));
  }
  // e ~ 2^{−p l}, l halvings after the first: below the errors, at that end where these are nearer to it
  const double first = levels.front()->*table.norm, last = levels.back()->*table.norm;
  const auto halvings = static_cast<double>(levels.back() - levels.front());  // they lie in one list
  std::size_t dashes = 2;
  for (const double order : orders) {
    const double fall = std::exp2(order * halvings), begin = 0.5 * std::min(first, last * fall);
    data += fmt::format("{} {}\n{} {}\n", place(*levels.front()), begin, place(*levels.back()), begin / fall);
    least = std::min(least, begin / fall);
    end_curve(fmt::format("lines lw 1.2 dt {} lc rgb '#777777' title 'order {:.3g}'", dashes++, order));
  }
  write_text_file(scratch / "errors", data);
  for (const ConvergenceLevel* level : levels)
    tics += fmt::format("{}'{:.6g}' {}", tics.empty() ? "" : ", ", place(*level), place(*level));
  const double decades = std::log10(most / least);
  return figure_title(scene.name + ": errors at halved steps", fmt::format("{}, {}", scene.problem.theory, label)) +
         fmt::format(
             "set lmargin at screen 0.13\nset rmargin at screen 0.965\n"
             "set bmargin at screen 0.12\nset tmargin at screen top\n"
             "set grid lc rgb '#e4e4e4' lt 1 lw 0.7\nset logscale xy\nset mxtics 1\nset mytics 10\n"
             "set format y '10^{{%T}}'\nset ytics 1e{}\nset xtics ({})\nset xlabel '{}'\n"
             "set label 103 '{} of the last row' at screen 0.025,0.4875 center rotate textcolor rgb '#333333'\n"
             "set key bottom left Left reverse samplen 2.4 spacing 1.2 textcolor rgb '#333333'\n"
             "set xrange [{}:{}]\nset yrange [{}:{}]\nplot {}\n",
             std::max(1.0, nice_step(decades + 1, 10)), tics, point ? "steps in a unit of time" : "sites N",
             table.exact ? "error" : "difference from the next run", place(*levels.front()) / 1.15,
             place(*levels.back()) * 1.15, least / 1.8, most * 1.8, plots);
}

}  // namespace

std::string draw_convergence(const Scene& scene, const std::string& label, const ConvergenceTable& table,
                             const std::vector<double>& orders, const std::filesystem::path& folder) {
  return draw({{convergence_figure,
                [&](const std::filesystem::path& scratch) { return figure(scene, label, table, orders, scratch); }}},
              scene.figure_form, folder);
}

}  // namespace delf
