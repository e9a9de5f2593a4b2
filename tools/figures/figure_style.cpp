// SPDX-License-Identifier: MIT
#include "tools/figures/figure_style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tools/figures/gnuplot.hpp"
#include "tools/report/text_columns.hpp"

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

// One size on paper: a third of it for each of the letters of 12 points.
const char* terminal(std::string_view format) {
  if (format == "png") return "pngcairo size 1800,1200 font 'DejaVu Sans,12' fontscale 2.1 linewidth 2.2";
  if (format == "pdf") return "pdfcairo size 18cm,12cm font 'DejaVu Sans,12' fontscale 0.6 linewidth 1.3";
  return "svg size 900,600 font 'sans-serif,12' fontscale 1.2 linewidth 1.1 background '#ffffff'";
}

// Text from the left to the right of the figure, whole: smaller where it is long, and on lines of its own below where it is
// longer still.
std::string fitted_label(int number, const std::string& text, double y, double size, const char* colour) {
  constexpr double letters = 95 * 11;  // of size 1 that fit
  constexpr double least = 8, between_lines = 0.0215;
  const auto columns = static_cast<double>(columns_of(text));
  const double fitted = std::clamp(letters / std::max(1.0, columns), std::min(least, size), size);
  const std::size_t room = letters / fitted + 1e-9;  // all columns, where the size is fitted to them
  std::vector<std::string> lines{""};
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (!lines.back().empty() && columns_of(lines.back()) + 1 + columns_of(word) > room) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
    begin = end + 1;
  }
  std::string labels;
  y += between_lines / 2 * static_cast<double>(lines.size() - 1);
  for (const std::string& line : lines) {
    labels +=
        fmt::format("if (titles) set label {} {} at screen 0.03,{} left font ',{:.3g}' textcolor rgb '{}' noenhanced\n",
                    number++, gnuplot_quoted(line), y, fitted, colour);
    y -= between_lines;
  }
  return labels;
}

}  // namespace

ColourScale colour_scale(std::span<const double> values) {
  std::vector<double> sorted;
  for (const double v : values)
    if (std::isfinite(v)) sorted.push_back(v);
  if (sorted.empty()) return {-1, 1, true};
  std::sort(sorted.begin(), sorted.end());
  const auto quantile = [&](double q) { return sorted[q * static_cast<double>(sorted.size() - 1)]; };
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

std::string panel_tics(double from, double to, double width, std::optional<double> gap) {
  constexpr double letter = 0.0098;  // of the width of a figure
  const auto length = [](double tic) { return letter * static_cast<double>(fmt::format("{:.6g}", tic).size()); };
  double step = 0, first = 0, last = 0;
  for (int most = gap ? 5 : 10; most > 0; --most) {
    step = nice_step(to - from, most);
    first = step * std::ceil(from / step - 1e-9), last = step * std::floor(to / step + 1e-9);
    const double longest = std::max({length(first), length(last), length(last - step)});
    if (longest + 1.5 * letter <= width * step / (to - from)) break;
  }
  const double beyond = (length(last) + length(from)) / 2 + letter - width * (to - last) / (to - from);
  if (gap && beyond > *gap && last > first) last -= step;
  return fmt::format("set xtics {},{},{}\n", first, step, last + step / 100);
}

std::string component_colour(std::size_t component) {
  constexpr std::array<const char*, line_colours> colours{line_colour, "#d55e00", "#1a1a80",
                                                          "#20a39e",   "#4d2c14", "#555555"};
  return colours[component % colours.size()];
}

std::string gnuplot_style() { return style; }

std::string figure_script(const std::string& name, const std::string& body, const FigureForm& form) {
  std::string script;
  for (const std::string& format : form.formats)
    script += fmt::format("reset\nset terminal {}\nset output '{}.{}'\ntitles = {}\ntop = {}\n", terminal(format), name,
                          format, form.titles ? 1 : 0, form.titles ? 0.855 : 0.935) +
              style + body + "unset output\n";
  return script;
}

std::string figure_title(const std::string& title, const std::string& subtitle) {
  return fitted_label(91, title, 0.955, 16, "#111111") + fitted_label(93, subtitle, 0.908, 11, "#666666");
}

std::string key_of_curves(std::size_t count, const std::function<std::string(std::size_t)>& name,
                          const std::vector<std::vector<double>>& curves) {
  if (count < 2) return {};
  std::vector<double> all;
  for (const auto& curve : curves) all.insert(all.end(), curve.begin(), curve.end());
  const ColourScale scale = colour_scale(all);
  const auto on = coinciding(curves, scale.most - scale.least);
  constexpr double room = 0.4;  // of the width; the title is to the left
  std::vector<std::string> words;
  std::vector<double> widths;
  double all_widths = 0;
  for (std::size_t c = 0; c < count && all_widths < room; ++c) {
    words.push_back(name(c) + (on[c] < c ? fmt::format(" (on {})", name(on[c])) : ""));
    widths.push_back(0.025 + 0.0105 * static_cast<double>(columns_of(words.back())));
    all_widths += widths.back();
  }
  if (words.size() < count) words.back() = "...";  // more than fit
  std::string labels;
  double x = 0.97;
  for (std::size_t c = words.size(); c-- > 0; x -= widths[c])
    labels += fmt::format(
        "set label {} {} at screen {},(titles ? 0.955 : 0.975) right font ',11' textcolor rgb '{}' noenhanced\n",
        110 + c, gnuplot_quoted(words[c]), x, component_colour(c));
  return labels;
}

std::string robust_range(const char* axis, const std::vector<std::vector<double>>& curves) {
  std::vector<double> all;
  for (const auto& curve : curves)
    for (const double v : curve)
      if (std::isfinite(v)) all.push_back(v);
  if (all.empty()) return {};
  const auto [least, most] = std::ranges::minmax(all);
  const ColourScale scale = colour_scale(all);
  if (scale.swings ? std::max(-least, most) <= 1.001 * scale.most : most - least <= 1.001 * (scale.most - scale.least))
    return {};
  const double room = 0.06 * (scale.most - scale.least);
  return fmt::format("set {}range [{}:{}]\n", axis, scale.least - room, scale.most + room);
}

std::vector<std::size_t> coinciding(const std::vector<std::vector<double>>& curves, double range) {
  constexpr double line = 0.004;
  std::vector<std::size_t> on(curves.size());
  for (std::size_t c = 0; c < curves.size(); ++c) {
    on[c] = c;
    for (std::size_t before = 0; before < c && on[c] == c; ++before) {
      bool same = !curves[c].empty() && curves[c].size() == curves[before].size();
      for (std::size_t i = 0; same && i < curves[c].size(); ++i)
        same = std::abs(curves[c][i] - curves[before][i]) <= line * range;
      if (same) on[c] = before;
    }
  }
  return on;
}

}  // namespace delf
