// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "lattice/read_number.hpp"
#include "tools/figures/drawing.hpp"
#include "tools/figures/figure_style.hpp"
#include "tools/figures/gnuplot.hpp"
#include "tools/files/text_file.hpp"
#include "tools/sweep/compared_runs.hpp"
#include "tools/sweep/sweep_outcome.hpp"

namespace delf {

namespace {

struct Point {
  std::vector<double> at;  ///< values of the keys with numbers
  std::string words;       ///< of the others
  double number;
};

// A logarithmic axis for positive numbers over two powers of ten.
bool wide(const std::vector<double>& values) {
  const auto [least, most] = std::ranges::minmax(values);
  return least > 0 && most > 100 * least;
}

std::string axis(const char* which, const std::vector<double>& values) {
  return wide(values) ? fmt::format("set logscale {0}\nset format {0} '10^{{%T}}'\n", which) : "";
}

std::string label(const char* which, const std::string& text) {
  return fmt::format("set {}label {} noenhanced\n", which, gnuplot_quoted(text));
}

// One line for each combination of words.
std::string lines(const std::string& key, const std::string& number, const std::vector<Point>& points,
                  const std::filesystem::path& scratch) {
  std::map<std::string, std::vector<const Point*>> groups;
  std::vector<double> all_x, all_y;
  for (const Point& p : points) {
    groups[p.words].push_back(&p);
    all_x.push_back(p.at[0]);
    if (std::isfinite(p.number)) all_y.push_back(p.number);
  }
  if (all_y.empty()) return {};
  std::string script =
      "set lmargin at screen 0.135\nset rmargin at screen 0.965\nset bmargin at screen 0.13\n"
      "set tmargin at screen top\nset grid lc rgb '#e4e4e4' lt 1 lw 0.7\n" +
      label("x", key) + label("y", number) + axis("x", all_x) + axis("y", all_y);
  if (groups.size() > 1) script += "set key top right font ',10'\n";
  const double size = points.size() > 120 ? 0.25 : 0.6;
  std::size_t which = 0;
  std::string plots;
  for (auto& [words, group] : groups) {
    std::ranges::stable_sort(group, {}, [](const Point* p) { return p->at[0]; });
    std::string table;
    for (const Point* p : group)
      table +=
          std::isfinite(p->number) ? fmt::format("{} {}\n", p->at[0], p->number) : "\n";  // a gap where there is none
    const std::string file = fmt::format("sweep{}", which);
    write_text_file(scratch / file, table);
    plots += fmt::format("{}'{}' using 1:2 with linespoints pt 7 ps {} lw 0.8 lc rgb '{}' title {} noenhanced",
                         plots.empty() ? "plot " : ", ", file, size, component_colour(which), gnuplot_quoted(words));
    ++which;
  }
  return script + plots + "\n";
}

// A point in colour for each run; a grid where there is a run for each pair.
std::string map(const std::vector<std::string>& keys, const std::string& number, const std::vector<Point>& points,
                const std::filesystem::path& scratch) {
  std::vector<double> x, y, values;
  std::string table;
  for (const Point& p : points) {
    if (!std::isfinite(p.number)) continue;
    x.push_back(p.at[0]), y.push_back(p.at[1]), values.push_back(p.number);
    table += fmt::format("{} {} {}\n", p.at[0], p.at[1], p.number);
  }
  if (values.empty()) return {};
  write_text_file(scratch / "sweep", table);
  const std::size_t across = std::set<double>(x.begin(), x.end()).size(),
                    up = std::set<double>(y.begin(), y.end()).size();
  const bool grid = across > 1 && up > 1 && across * up == values.size() && !wide(x) && !wide(y);
  return "set lmargin at screen 0.12\nset rmargin at screen 0.84\nset bmargin at screen 0.13\nset tmargin at screen "
         "0.86\n" +
         label("x", keys[0]) + label("y", keys[1]) + label("cb", number) + axis("x", x) + axis("y", y) +
         gnuplot_colours(colour_scale(values)) +
         (grid ? "set autoscale fix\nplot 'sweep' using 1:2:3 with image\n"
               : "plot 'sweep' using 1:2:3 with points pt 7 ps 1 lc palette\n");
}

bool has_numbers(const SweepOutcome& outcome, std::size_t key) {
  return std::ranges::all_of(outcome.values, [&](const auto& v) { return read_finite(v[key]).has_value(); });
}

// "stencil = triangle, courant = 0.5"
std::string words_of(const SweepRequest& request, const SweepOutcome& outcome, std::size_t row,
                     const std::vector<std::size_t>& keys) {
  std::string words;
  for (const std::size_t a : keys)
    words += (words.empty() ? "" : ", ") + request.keys[a].substr(request.keys[a].find('.') + 1) + " = " +
             outcome.values[row][a];
  return words;
}

std::string draw_side_by_side(const SweepRequest& request, const SweepOutcome& outcome, const FigureForm& form,
                              const std::filesystem::path& folder) {
  constexpr std::size_t most_runs = 24;  // as many as colours and dashes distinguish
  if (outcome.rows.size() > most_runs || request.table) return {};
  std::vector<std::size_t> keys;
  for (std::size_t a = 0; a < request.keys.size(); ++a) keys.push_back(a);
  std::vector<ComparedRun> runs;
  for (std::size_t i = 0; i < outcome.rows.size(); ++i) {
    const std::string words = keys.size() == 1 ? outcome.values[i][0] : words_of(request, outcome, i, keys);
    if (!outcome.rows[i].folder.empty())
      runs.push_back(compared_run(words, request.run(outcome.values[i]).scene, folder / outcome.rows[i].folder));
  }
  const std::string title = figure_title(fmt::format("{}: side by side", outcome.scene),
                                         fmt::format("{} runs over {}", runs.size(), fmt::join(request.keys, " and ")));
  return draw({{"sweep",
                [&](const std::filesystem::path& scratch) {
                  const std::string body = compared_runs_figure(runs, scratch);
                  return body.empty() ? body : title + body;
                }}},
              form, folder);
}

}  // namespace

bool is_side_by_side(const SweepRequest& request, const SweepOutcome& outcome) {
  if (request.compare) return true;
  for (std::size_t a = 0; a < request.keys.size(); ++a)
    if (has_numbers(outcome, a)) return false;
  return true;
}

std::string draw_sweep(const SweepRequest& request, const SweepOutcome& outcome, const FigureForm& form,
                       const std::filesystem::path& folder) {
  if (outcome.rows.size() < 2 || outcome.number.empty()) return {};
  if (is_side_by_side(request, outcome)) return draw_side_by_side(request, outcome, form, folder);
  std::vector<std::size_t> numeric, worded;
  for (std::size_t a = 0; a < request.keys.size(); ++a) (has_numbers(outcome, a) ? numeric : worded).push_back(a);
  const std::size_t axes = numeric.size() == 2 && worded.empty() ? 2 : 1;
  for (std::size_t a = axes; a < numeric.size(); ++a) worded.push_back(numeric[a]);
  std::vector<Point> points;
  for (std::size_t i = 0; i < outcome.rows.size(); ++i) {
    Point p{{}, {}, outcome.rows[i].number(outcome.number)};
    for (std::size_t a = 0; a < axes; ++a) p.at.push_back(*read_finite(outcome.values[i][numeric[a]]));
    p.words = words_of(request, outcome, i, worded);
    points.push_back(std::move(p));
  }
  std::vector<std::string> keys;
  for (std::size_t a = 0; a < axes; ++a) keys.push_back(request.keys[numeric[a]]);
  const std::string title = figure_title(fmt::format("{}: {}", outcome.scene, outcome.number),
                                         fmt::format("{} runs over {}", outcome.rows.size(), fmt::join(keys, " and ")));
  return draw({{"sweep",
                [&](const std::filesystem::path& scratch) {
                  const std::string body = axes == 2 ? map(keys, outcome.number, points, scratch)
                                                     : lines(keys[0], outcome.number, points, scratch);
                  return body.empty() ? body : title + body;
                }}},
              form, folder);
}

}  // namespace delf
