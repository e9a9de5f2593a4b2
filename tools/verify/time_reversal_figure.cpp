// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/figures/figure_style.hpp"
#include "tools/files/text_file.hpp"
#include "tools/verify/verdict_figures.hpp"

namespace delf {

std::string time_reversal_figure(const VerdictSource& source, const std::filesystem::path& scratch) {
  const ReversalCurve& curve = source.verdict.reversal;
  std::string table;
  bool zero = false;
  double first = 1e300, last = 0, least = 1e-16, most = 1e-15;
  for (std::size_t i = 0; i < std::min(curve.steps.size(), curve.distance.size()); ++i) {
    const auto steps = static_cast<double>(curve.steps[i]);
    if (steps < 1 || !std::isfinite(curve.distance[i])) continue;  // a logarithmic axis has no place for these
    const double distance = drawn_logarithmic(curve.distance[i]);
    zero = zero || curve.distance[i] < drawn_zero;
    table += fmt::format("{} {}\n", steps, distance);
    first = std::min(first, steps), last = std::max(last, steps);
    least = std::min(least, distance), most = std::max(most, distance);
  }
  if (table.empty()) return {};
  write_text_file(scratch / "reversal", table);
  const double end = std::max(last, 10 * first) * 1.3;
  return verdict_title(source.scene + ": steps forth and back",
                       "how far from the first rows the run then ends" + std::string(zero ? ", 0 drawn at 10⁻¹⁸" : ""),
                       source.scheme) +
         fmt::format(
             "set lmargin at screen 0.13\nset rmargin at screen 0.965\n"
             "set bmargin at screen 0.12\nset tmargin at screen top\n"
             "set grid lc rgb '#e4e4e4' lt 1 lw 0.7\nset logscale xy\nset mxtics 1\nset mytics 1\n"
             "set format x '{}'\nset format y '10^{{%T}}'\nset ytics 1e{}\nset xlabel 'steps in each direction'\n"
             "set label 103 'distance' at screen 0.025,0.4875 center rotate textcolor rgb '#333333'\n"
             "set xrange [{}:{}]\nset yrange [{}:{}]\n"
             "plot 'reversal' using 1:2 with linespoints lw 1.3 pt 7 ps (GPVAL_TERM eq 'svg' ? 0.5 : 1.3) lc rgb "
             "'{}'\n",
             end < 1e5 ? "%h" : "10^{%T}", std::max(1.0, nice_step(std::log10(most / least), 8)), first / 1.3, end,
             least / 3, most * 3, line_colour);
}

}  // namespace delf
