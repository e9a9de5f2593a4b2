// SPDX-License-Identifier: MIT
#include "tools/figures/error_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "lattice/index.hpp"
#include "tools/figures/figure_style.hpp"
#include "tools/files/text_file.hpp"

namespace delf {

namespace {

/// The largest error of the fields at each site, wherever it is.
std::vector<double> errors_of(const FigureSource& source, int frame) {
  const auto mesh = source.names.drawn_mesh();
  const double unit = source.angle ? 2 * std::numbers::pi : 1;
  const std::vector<double> places = mesh ? drawn_sites(source, frame, *mesh) : source.thinned.space();
  std::vector<double> errors(places.size(), 0.0);
  std::vector<FieldPoint> exact(at(source.exact->components()));
  std::vector<std::vector<double>> fields;
  for (std::size_t c = 0; c < source.thinned.components(); ++c)
    if (c != mesh) fields.push_back(drawn_sites(source, frame, c));
  for (std::size_t i = 0; i < places.size(); ++i) {
    source.exact->at(source.thinned.time(frame), places[i], exact);
    for (std::size_t a = 0; a < std::min(fields.size(), exact.size()); ++a)
      errors[i] = std::max(errors[i], std::abs(unit * fields[a][i] - exact[a].phi));
  }
  return errors;
}

/// The errors at evenly spaced places: as they are, or between sites that move.
std::vector<double> even_errors(const FigureSource& source, int frame, const std::vector<double>& space) {
  std::vector<double> errors = errors_of(source, frame);
  if (!source.names.drawn_mesh()) return errors;
  const std::vector<double> nodes = drawn_sites(source, frame, *source.names.drawn_mesh());
  std::vector<double> there;
  for (const double x : space) {
    const std::size_t b = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, x) - nodes.begin(), a = b - 1;
    const double part = std::clamp((x - nodes[a]) / (nodes[b] - nodes[a]), 0.0, 1.0);
    there.push_back(errors[a] + part * (errors[b] - errors[a]));
  }
  return there;
}

}  // namespace

std::string error_figure(const FigureSource& source, const std::filesystem::path& scratch) {
  constexpr int most_rows = 300;  // the solution costs more than the rows
  if (!source.exact || source.thinned.space().size() < 3) return {};
  const ThinnedRows& thinned = source.thinned;
  int frames = std::min(thinned.even_frames(), tame_frames(source));
  while (frames > 0 && thinned.time(frames - 1) > source.exact->exact_until()) --frames;
  if (frames < 2) return {};
  const int apart = (frames + most_rows - 1) / most_rows, rows = (frames - 1) / apart + 1;
  if (rows < 2) return {};
  const std::vector<double> space = source.names.drawn_mesh() ? drawn_space(source) : thinned.space();
  std::vector<double> map;
  for (int r = 0; r < rows; ++r) {
    const std::vector<double> errors = even_errors(source, r * apart, space);
    map.insert(map.end(), errors.begin(), errors.end());
  }
  // From the error that only a hundredth is below, but eight decades at most, to the largest.
  std::vector<double> sorted;
  for (const double e : map)
    if (std::isfinite(e) && e > 0) sorted.push_back(e);
  if (sorted.empty()) return {};
  std::ranges::sort(sorted);
  const double most = std::pow(10, std::ceil(std::log10(sorted.back()))),
               least = std::clamp(std::pow(10, std::floor(std::log10(sorted[sorted.size() / 100]))), 1e-8 * most,
                                  0.1 * most);
  for (double& e : map) e = std::clamp(e, least, most);
  write_text_file(scratch / "errors", {reinterpret_cast<const char*>(map.data()), map.size() * sizeof(double)});
  const double dx = space[1] - space[0], t0 = thinned.time(0), t1 = thinned.time((rows - 1) * apart),
               dt = (t1 - t0) / (rows - 1);
  const bool cut = thinned.time(thinned.frames() - 1) > t1 + 1.5 * dt;
  return gnuplot_colours({least, most, false}) +
         figure_title(fmt::format("{}: the error against the exact solution, over space and time", source.scene),
                      subtitle(source) + (cut ? "; as long as there is one" : "")) +
         fmt::format(
             "set lmargin at screen 0.105\nset rmargin at screen 0.855\n"
             "set bmargin at screen 0.12\nset tmargin at screen top\n"
             "set xlabel 'space x'\nset label 103 'time t' at screen 0.025,0.4875 center rotate textcolor rgb "
             "'#333333'\n"
             "set label 104 '|error|' at screen 0.886,(top+0.03) center textcolor rgb '#333333' noenhanced\n"
             "set border 15\nset colorbox user origin screen 0.875,0.12 size screen 0.022,(top-0.12) noborder\n"
             "set logscale cb\nset format cb '10^{{%T}}'\nset cbtics 10 scale 0.3\n"
             "set xrange [{}:{}]\nset yrange [{}:{}]\n"
             "plot 'errors' binary array=({},{}) dx={} dy={} origin=({},{}) format='%double' using 1 with image\n",
             space.front() - dx / 2, space.back() + dx / 2, t0 - dt / 2, t1 + dt / 2, space.size(), rows, dx, dt,
             space.front(), t0);
}

}  // namespace delf
