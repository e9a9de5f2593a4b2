// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "tools/figures/figure_style.hpp"
#include "tools/figures/gnuplot.hpp"
#include "tools/files/text_file.hpp"
#include "tools/verify/verdict_figures.hpp"

namespace delf {

namespace {

// Kinds differ in shape and in colour; gnuplot's even shapes are open, the odd ones after them filled.
std::string mark(std::size_t kind, bool filled) {
  constexpr std::array shapes{6, 4, 8, 12, 10, 14};
  constexpr std::array colours{"#31688e", "#d95f02", "#1b9e77", "#7570b3", "#e7298a", "#a6761d", "#666666"};
  return fmt::format("pt {} lc rgb '{}'", shapes[kind % shapes.size()] + (filled ? 1 : 0),
                     colours[kind % colours.size()]);
}

std::vector<std::string> kinds_of(const std::vector<RegionPoint>& points) {
  std::vector<std::string> kinds;
  for (const RegionPoint& p : points)
    if (std::ranges::find(kinds, p.kind) == kinds.end()) kinds.push_back(p.kind);
  return kinds;
}

std::set<double> tolerances(const Verdict& v) {
  std::set<double> all;
  for (const Check& c : v.checks)
    if (c.name.starts_with("form formula") && c.tolerance > 0) all.insert(c.tolerance);
  return all;
}

struct LogRange {
  double least, most;
};

double stencils_of(const RegionPoint& p) { return static_cast<double>(std::max<std::int64_t>(p.stencils, 1)); }

LogRange range_of_stencils(const std::vector<RegionPoint>& points) {
  LogRange range{1e300, 0};
  for (const RegionPoint& p : points)
    range = {std::min(range.least, stencils_of(p)), std::max(range.most, stencils_of(p))};
  return {range.least / 1.5, std::max(range.most, 10 * range.least) * 1.5};
}

LogRange range_of_values(const Verdict& v) {
  LogRange range{1e-17, 1e-15};
  for (const RegionPoint& p : v.points)
    if (std::isfinite(p.value))
      range = {std::min(range.least, drawn_logarithmic(p.value)), std::max(range.most, drawn_logarithmic(p.value))};
  for (const double tolerance : tolerances(v)) range.most = std::max(range.most, tolerance);
  return {range.least / 3, range.most * 10};
}

// One table for each kind, filled points in the first and open ones in the second column of values; what is not a
// number goes into a last table, to the top of the figure.
std::string tables(const std::vector<RegionPoint>& points, const std::vector<std::string>& kinds, double top) {
  std::string text;
  for (const std::string& kind : kinds) {
    for (const RegionPoint& p : points)
      if (p.kind == kind && std::isfinite(p.value))
        text += fmt::format("{} {}{}\n", stencils_of(p), p.local ? "" : "NaN ", drawn_logarithmic(p.value));
    text += "NaN NaN NaN\n\n\n";  // so that no table is empty
  }
  for (const RegionPoint& p : points)
    if (!std::isfinite(p.value)) text += fmt::format("{} {}\n", stencils_of(p), top / 2);
  return text;
}

std::string plots(const Verdict& v, const std::vector<std::string>& kinds) {
  const bool evolved = std::ranges::any_of(v.points, [](const RegionPoint& p) { return !p.local; });
  const bool wrong = std::ranges::any_of(v.points, [](const RegionPoint& p) { return !std::isfinite(p.value); });
  std::string text = "plot 1e-16*sqrt(x) with lines lc rgb '#999999' lw 1.2 title 'round-off: 10^{−16}√n'";
  const char* title = "title 'tolerance'";
  for (const double tolerance : tolerances(v)) {
    text += fmt::format(", {} with lines lc rgb '#b2182b' lw 1.2 dt (12,6) {}", tolerance, title);
    title = "notitle";
  }
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    text += fmt::format(", 'regions' index {} using 1:2 with points {} ps size notitle", k, mark(k, true));
    text += fmt::format(", '' index {} using 1:3 with points {} ps size notitle", k, mark(k, false));
    text += fmt::format(", NaN with points {} ps size title {} noenhanced", mark(k, true), gnuplot_quoted(kinds[k]));
  }
  if (evolved)
    text +=
        ", NaN with points pt 7 ps size lc rgb '#444444' title 'filled: local V, W'"
        ", NaN with points pt 6 ps size lc rgb '#444444' title 'open: evolved V, W'";
  if (wrong)
    text += fmt::format(", 'regions' index {} using 1:2 with points pt 2 ps size lc rgb '#b2182b' title 'not a number'",
                        kinds.size());
  return text + "\n";
}

}  // namespace

std::string residual_region_figure(const VerdictSource& source, const std::filesystem::path& scratch) {
  const Verdict& v = source.verdict;
  if (v.points.empty()) return {};
  const std::vector<std::string> kinds = kinds_of(v.points);
  const LogRange x = range_of_stencils(v.points), y = range_of_values(v);
  write_text_file(scratch / "regions", tables(v.points, kinds, y.most));
  const bool zero = std::ranges::any_of(v.points, [](const RegionPoint& p) { return p.value < drawn_zero; });
  const double decades = std::log10(y.most / y.least);
  return verdict_title(source.scene + ": the form formula on regions of all kinds", source.scheme,
                       zero ? "0 is drawn at 10⁻¹⁸" : "") +
         fmt::format(
             "size = GPVAL_TERM eq 'svg' ? 0.65 : 2.0\n"
             "set lmargin at screen 0.13\nset rmargin at screen 0.7\n"
             "set bmargin at screen 0.12\nset tmargin at screen top\n"
             "set grid lc rgb '#e4e4e4' lt 1 lw 0.7\nset logscale xy\nset mxtics 1\nset mytics 1\n"
             "set format x '{}'\nset format y '10^{{%T}}'\nset ytics 1e{}\n"
             "set xlabel 'stencils in the region, n'\n"
             "set label 103 'residual |sum| / Σ|terms|' at screen 0.025,0.4875 center rotate textcolor rgb '#333333' "
             "noenhanced\n"
             "set key at screen 0.715,top left top Left reverse samplen 2 spacing 1.25 textcolor rgb '#333333'\n"
             "set samples 200\nset xrange [{}:{}]\nset yrange [{}:{}]\n",
             x.most < 1e5 ? "%h" : "10^{%T}", std::max(1.0, nice_step(decades, 10)), x.least, x.most, y.least, y.most) +
         plots(v, kinds);
}

}  // namespace delf
