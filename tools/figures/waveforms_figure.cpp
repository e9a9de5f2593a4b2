// SPDX-License-Identifier: MIT
#include "tools/figures/waveforms_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "tools/figures/figure_style.hpp"
#include "tools/files/text_file.hpp"

namespace delf {

namespace {

constexpr int most_panels = 6, columns = 3;

std::vector<int> chosen_frames(const FigureSource& source) {
  const ThinnedRows& thinned = source.thinned;
  std::vector<double> times = source.times;
  const int tame = tame_frames(source), panels = std::min(tame, most_panels);
  if (times.empty())
    for (int p = 0; p < panels; ++p)
      times.push_back(thinned.time(0) + (thinned.time(tame - 1) - thinned.time(0)) * p / std::max(1, panels - 1));
  std::vector<int> frames;
  for (const double t : times) {
    int nearest = 0;
    for (int f = 1; f < thinned.frames(); ++f)
      if (std::abs(thinned.time(f) - t) < std::abs(thinned.time(nearest) - t)) nearest = f;
    frames.push_back(nearest);
  }
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  if (frames.size() > most_panels) frames.resize(most_panels);
  return frames;
}

double mean(std::span<const double> row) {
  return std::accumulate(row.begin(), row.end(), 0.0) / static_cast<double>(row.size());
}

constexpr auto exact_colour = "#cccccc";

/// A component of the exact solution at a time, less some turns, as lines of a table; empty after the time until which it
/// can be compared with.
std::string exact_curve(const FigureSource& source, double t, std::size_t component, double turns,
                        std::vector<double>& shown) {
  if (!source.exact || t > source.exact->exact_until()) return {};
  constexpr int points = 600;
  const double unit = source.angle ? 2 * std::numbers::pi : 1;
  std::vector<FieldPoint> here(source.exact->components());
  std::string table;
  for (int n = 0; n <= points; ++n) {
    const double x = source.lattice.length() * n / points;
    source.exact->at(t, x, here);
    shown.push_back(here[component].phi / unit - turns);
    table += fmt::format("{} {}\n", x, shown.back());
  }
  return table + "\n\n";
}

}  // namespace

std::string waveforms_figure(const FigureSource& source, const std::filesystem::path& scratch) {
  if (source.thinned.frames() == 0 || source.lattice.space() == Space::point) return {};
  const auto frames = chosen_frames(source);
  const auto space = drawn_space(source);
  const int panels = static_cast<int>(frames.size());

  // An angle grows or falls as solitons pass: multiples of 2π are subtracted from the whole row, never site by site.
  std::string table, exact;
  int exact_curves = 0;
  std::vector<double> shown;
  std::vector<std::vector<double>> curves;  // of each component, in all panels
  bool turned = false;
  std::vector<std::size_t> components;
  for (std::size_t c = 0; c < source.thinned.components(); ++c)
    if (c != source.names.drawn_mesh()) components.push_back(c);
  curves.resize(components.size());
  for (const int f : frames) {
    const auto nodes = source.names.drawn_mesh() ? drawn_sites(source, f, *source.names.drawn_mesh()) : space;
    for (std::size_t which = 0; which < components.size(); ++which) {
      const std::size_t c = components[which];
      const auto row = drawn_sites(source, f, c);
      const double drift = mean(row) - mean(drawn_sites(source, 0, c));
      const double turns = source.angle && std::isfinite(drift) ? std::round(drift) : 0;
      turned = turned || turns != 0;
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        shown.push_back(row[i] - turns);
        curves[which].push_back(shown.back());
        table += fmt::format("{} {}\n", nodes[i], shown.back());
      }
      table += "\n\n";
      const std::string curve = exact_curve(source, source.thinned.time(f), which, turns, shown);
      exact += curve, exact_curves += !curve.empty();
    }
  }
  write_text_file(scratch / "waveforms", table);
  if (exact_curves > 0) write_text_file(scratch / "exact", exact);

  const ColourScale scale = colour_scale(shown);
  const double room = 0.06 * (scale.most - scale.least);
  const int rows = (panels + columns - 1) / columns, in_a_row = std::min(columns, panels);
  constexpr double between = 0.03;
  const double width = (0.97 - 0.105 - between * (in_a_row - 1)) / in_a_row;
  std::string body =
      figure_title(
          fmt::format("{}: waveforms of {}", source.scene,
                      components.size() > 1 ? "the fields" : drawn_name(source, components[0])),
          fmt::format("{}, {}{}{}", source.theory, source.scheme, turned ? "; multiples of 2π are subtracted" : "",
                      exact_curves > 0 ? "; grey: exact" : "")) +
      (exact_curves > 0 ? "if (!titles) set label 105 'grey: exact' at screen 0.97,0.975 right font ',11' "
                          "textcolor rgb '#666666'\n"
                        : "") +
      fmt::format(
          "set multiplot layout {},{} margins screen 0.105,0.97,0.125,(top-0.035) spacing screen {},0.085\n"
          "set grid lc rgb '#e4e4e4' lt 1 lw 0.7\nset xrange [{}:{}]\nset yrange [{}:{}]\n",
          rows, in_a_row, between, space.front(), space.back(), scale.least - room, scale.most + room);
  for (int p = 0; p < panels; ++p) {
    const bool left = p % columns == 0, bottom = p + columns >= panels;
    body += fmt::format("set format y '{}'\nset format x '{}'\nset ylabel '{}'\nset xlabel '{}'\n", left ? "%h" : "",
                        bottom ? "%h" : "",
                        left ? std::string(components.size() > 1 ? "fields" : drawn_name(source, components[0])) +
                                   (source.angle ? " / 2π" : "") + (turned ? ", less whole turns" : "")
                             : "",
                        bottom ? "space x" : "");
    body += panel_tics(space.front(), space.back(), width,
                       (p + 1) % in_a_row != 0 && p + 1 < panels ? std::optional(between) : std::nullopt);
    body += fmt::format("set label 1 't = {:.4g}' at graph 0,1 left offset 0,0.7 textcolor rgb '#333333'\n",
                        source.thinned.time(frames[p]));
    if (p == 0)
      body += key_of_curves(
          components.size(), [&](std::size_t c) { return drawn_name(source, components[c]); }, curves);
    const int first = p * static_cast<int>(components.size());
    body += "plot ";
    for (int c = 0; c < static_cast<int>(components.size()) && first + c < exact_curves; ++c)
      body += fmt::format("'exact' index {} using 1:2 with lines lw 4 lc rgb '{}', ", first + c, exact_colour);
    for (std::size_t c = 0; c < components.size(); ++c)
      body += fmt::format("{} 'waveforms' index {} using 1:2 with {} lw 1.6 lc rgb '{}'", c == 0 ? "" : ",",
                          first + static_cast<int>(c), source.names.drawn_mesh() ? "linespoints pt 7 ps 0.4" : "lines",
                          component_colour(c));
    body += "\nunset label\n";
  }
  return body + "unset multiplot\n";
}

}  // namespace delf
