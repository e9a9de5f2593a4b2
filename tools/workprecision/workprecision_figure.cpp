// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/figures/drawing.hpp"
#include "tools/figures/figure_style.hpp"
#include "tools/figures/gnuplot.hpp"
#include "tools/files/text_file.hpp"
#include "tools/report/step_clock.hpp"
#include "tools/report/text_columns.hpp"
#include "tools/workprecision/workprecision_outcome.hpp"

namespace delf {

namespace {

// Distinguishable by the colour-blind, and from the grey of the others.
constexpr const char* engine_colours[] = {"#31688e", "#1b9e77", "#7570b3", "#66a61e",
                                          "#0099c6", "#a6761d", "#440154", "#005f73"};
constexpr const char* peer_colours[] = {"#d95f02", "#e7298a", "#b2182b", "#e6ab02"};

struct Drawn {
  const WorkPrecisionLine* line;
  double behind;  // the least factor, over all accuracies, by which it is slower than the best of all
};

// The scheme's cost at an accuracy: its cheapest run that reaches it.
double cost_at(const WorkPrecisionOutcome& o, const WorkPrecisionLine& line, double accuracy) {
  for (const std::size_t i : line.front)
    if (o.runs[i].error_linf <= accuracy) return o.runs[i].seconds;
  return std::numeric_limits<double>::infinity();
}

// Lines from the best to the worst.
std::vector<Drawn> ranked(const WorkPrecisionOutcome& o) {
  std::vector<Drawn> all;
  for (const WorkPrecisionLine& line : o.lines)
    if (!line.front.empty()) all.push_back({&line, std::numeric_limits<double>::infinity()});
  for (const WorkPrecisionCost& cost : o.costs) {
    double best = std::numeric_limits<double>::infinity();
    for (const Drawn& d : all) best = std::min(best, cost_at(o, *d.line, cost.accuracy));
    if (!std::isfinite(best)) continue;
    for (Drawn& d : all) d.behind = std::min(d.behind, cost_at(o, *d.line, cost.accuracy) / best);
  }
  // the scene's own scheme has a colour and a name, however slow it is
  for (Drawn& d : all)
    if (d.line->own) d.behind = 0;
  std::ranges::stable_sort(all, {}, &Drawn::behind);
  return all;
}

double drawn_error(double error) { return std::clamp(error, 1e-17, 1e10); }

std::string figure(const Scene& scene, const WorkPrecisionOutcome& o, const std::filesystem::path& scratch) {
  std::vector<Drawn> all = ranked(o);
  if (all.empty()) return {};
  std::string plots, table, named;
  std::size_t block = 0, engine = 0, peer = 0;
  // the axes are those of the coloured lines: runs of others that failed would flatten them
  double least = 1e300, most = 0, fastest = 1e300, slowest = 0;
  const auto add = [&](std::span<const std::size_t> front, bool seen) {
    for (const std::size_t i : front) {
      const double error = drawn_error(o.runs[i].error_linf), seconds = std::max(o.runs[i].seconds, 1e-9);
      table += fmt::format("{} {}\n", seconds, error);
      if (!seen) continue;
      least = std::min(least, error), most = std::max(most, error);
      fastest = std::min(fastest, seconds), slowest = std::max(slowest, seconds);
    }
    table += "\n\n";
    return block++;
  };
  // the envelope of the engine below all lines
  std::vector<std::size_t> envelope;
  for (std::size_t i = 0; i < o.runs.size(); ++i)
    if (o.runs[i].on_envelope && !o.runs[i].peer) envelope.push_back(i);
  std::ranges::sort(envelope, {}, [&](std::size_t i) { return o.runs[i].seconds; });
  constexpr auto size = "(GPVAL_TERM eq 'svg' ? 0.45 : 1.1)";
  if (!envelope.empty())
    plots +=
        fmt::format("'runs' index {} using 1:2 with lines lw 9 lc rgb '#ffe08a' title 'lower envelope of the engine'",
                    add(envelope, true));
  bool others = false;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const WorkPrecisionLine& line = *all[i].line;
    const bool coloured = line.peer ? peer < std::size(peer_colours) : engine < std::size(engine_colours);
    const std::size_t at = add(line.front, coloured);
    if (!coloured) {
      if (!plots.empty()) plots += ", \\\n  ";
      plots += fmt::format("'runs' index {} using 1:2 with lines lw 0.8 lc rgb '#c4c4c4'{}{}", at,
                           line.peer ? " dt 2" : "", others ? " notitle" : " title 'others'");
      others = true;
      continue;
    }
    const char* colour = line.peer ? peer_colours[peer++] : engine_colours[engine++];
    const std::string slope = std::isfinite(line.slope) ? fmt::format("  {:.1f}", line.slope) : "";
    named += fmt::format(", \\\n  'runs' index {} using 1:2 with linespoints lw 1.5 pt {} ps {} lc rgb '{}'{} title {}",
                         at, line.peer ? 5 : 7, size, colour, line.peer ? " dt 2" : "",
                         gnuplot_quoted(shortened(line.scheme, 40) + slope));
  }
  if (plots.empty()) named.erase(0, named.find('\''));
  write_text_file(scratch / "runs", table);
  return figure_title(
             scene.name + ": error against run time",
             fmt::format("{}; {} of the steps alone; slopes beside the names{}", scene.problem.theory,
                         time_of_steps(scene.problem.threads),
                         std::ranges::any_of(o.runs, &WorkPrecisionRun::peer) ? "; other programs dashed" : "")) +
         fmt::format(
             "set lmargin at screen 0.115\nset rmargin at screen 0.61\n"
             "set bmargin at screen 0.12\nset tmargin at screen top\n"
             "set grid lc rgb '#e4e4e4' lt 1 lw 0.7\nset logscale xy\nset mxtics 1\nset mytics 1\n"
             "set format x '10^{{%T}}'\nset format y '10^{{%T}}'\nset ytics 1e{}\nset xlabel 'seconds'\n"
             "set label 103 'largest error of the field at the end' at screen 0.025,0.4875 center rotate textcolor rgb "
             "'#333333'\n"
             "set key at screen 0.62,top left top Left reverse samplen 1.6 font ',9' noenhanced textcolor rgb "
             "'#333333'\nset xrange [{}:{}]\nset yrange [{}:{}]\nplot {}{}\n",
             std::max(1.0, nice_step(std::log10(most / least) + 1, 10)), fastest / 1.5, slowest * 1.5, least / 2,
             most * 2, plots, named);
}

}  // namespace

std::string draw_workprecision(const Scene& scene, const WorkPrecisionOutcome& o, const std::filesystem::path& folder) {
  return draw({{"workprecision", [&](const std::filesystem::path& scratch) { return figure(scene, o, scratch); }}},
              scene.figure_form, folder);
}

}  // namespace delf
