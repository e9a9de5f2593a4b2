// SPDX-License-Identifier: MIT
#include "tools/figures/spacetime_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "lattice/index.hpp"
#include "tools/figures/figure_style.hpp"
#include "tools/files/text_file.hpp"

namespace delf {

namespace {

/// Paths of the sites of a mesh that moves, over the map (Tyranowski–Desbrun, Figs. 8 and 9). Nothing where sites rest.
std::string site_paths(const FigureSource& source, int frames, const std::filesystem::path& scratch) {
  constexpr std::size_t most = 60;
  const auto mesh = source.names.drawn_mesh();
  if (!mesh) return {};
  const std::size_t sites = source.thinned.space().size(), apart = (sites + most - 1) / most;
  std::string table;
  for (std::size_t i = 0; i < sites; i += apart) {
    for (int f = 0; f < frames; ++f)
      table += fmt::format("{} {}\n", drawn_sites(source, f, *mesh)[i], source.thinned.time(f));
    table += "\n";
  }
  write_text_file(scratch / "paths", table);
  // A light line on a dark one is seen on any colour of the map.
  return ", 'paths' using 1:2 with lines lw 1.5 lc rgb '#90202020', 'paths' using 1:2 with lines lw 0.6 lc rgb '#40ffffff'";
}

/// The sides of a map on the screen, as gnuplot has them, and the height of the name above its bar of colours.
struct Place {
  std::string left, right, bottom, top, name_at;
};
constexpr std::size_t most_maps = 4;

/// The map of one field, its bar of colours beside it.
std::string map_of(const FigureSource& source, std::size_t component, int frames, const Place& place,
                   const std::filesystem::path& scratch) {
  const ThinnedRows& thinned = source.thinned;
  std::vector<double> space = drawn_space(source);
  // a thinned circle may not close after a full interval: then the last column stays away
  const double dx = space[1] - space[0];
  if (space.back() - space[space.size() - 2] < 0.99 * dx) space.pop_back();

  std::vector<double> map;
  for (int f = 0; f < frames; ++f) {
    const auto frame = drawn_frame(source, f, component);
    map.insert(map.end(), frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(space.size()));
  }
  // an angle that has drifted by many multiples of 2π is shown by its distance from the vacua
  const auto tame = std::span(map).first(space.size() * at(std::min(frames, tame_frames(source))));
  const auto [least, most] = std::ranges::minmax(tame);
  const bool drifts = source.angle && most - least > 8;
  const std::string name = drawn_name(source, component);
  const std::string quantity = drifts ? "sin²(" + name + "/2)" : source.angle ? name + " / 2π" : name;
  if (drifts)
    std::ranges::transform(map, map.begin(),
                           [](double turns) { return std::pow(std::sin(std::numbers::pi * turns), 2); });
  const std::string file = fmt::format("map{}", component);
  write_text_file(scratch / file, {reinterpret_cast<const char*>(map.data()), map.size() * sizeof(double)});

  const ColourScale scale = colour_scale(tame);
  const double t0 = thinned.time(0), t1 = thinned.time(frames - 1), dt = (t1 - t0) / (frames - 1);
  return gnuplot_colours(scale) +
         fmt::format(
             "set lmargin at screen {0}\nset rmargin at screen {1}\n"
             "set bmargin at screen {2}\nset tmargin at screen {3}\n"
             "set label 104 '{4}' at screen {1}+0.031,{5} center textcolor rgb '#333333' noenhanced\n"
             "set border 15\nset colorbox user origin screen {1}+0.02,{2} size screen 0.022,{3}-{2} noborder\n"
             "set cbtics {6} scale 0.3\n",
             place.left, place.right, place.bottom, place.top, quantity, place.name_at,
             nice_step(scale.most - scale.least, 8)) +
         fmt::format(
             "set xrange [{}:{}]\nset yrange [{}:{}]\n"
             "plot '{}' binary array=({},{}) dx={} dy={} origin=({},{}) format='%double' using 1 with image{}\n",
             space.front() - dx / 2, space.back() + dx / 2, t0 - dt / 2, t1 + dt / 2, file, space.size(), frames, dx,
             dt, space.front(), t0, site_paths(source, frames, scratch));
}

}  // namespace

std::string spacetime_figure(const FigureSource& source, const std::filesystem::path& scratch) {
  const int frames = source.thinned.even_frames();
  if (frames < 2 || source.thinned.space().size() < 2) return {};
  std::vector<std::size_t> fields;
  for (std::size_t c = 0; c < source.thinned.components(); ++c)
    if (c != source.names.drawn_mesh()) fields.push_back(c);
  const bool one = fields.size() == 1;
  const std::string axes =
      "set xlabel 'space x'\nset label 103 'time t' at screen 0.025,0.4875 center rotate textcolor rgb '#333333'\n";
  std::string body = figure_title(
      fmt::format("{}: the field{} over space and time", source.scene, one ? "" : "s"),
      subtitle(source) +
          (fields.size() > most_maps ? fmt::format("; the first {} of {}", most_maps, fields.size()) : ""));
  if (one)
    return body + axes + map_of(source, fields[0], frames, {"0.105", "0.855", "0.12", "top", "(top+0.03)"}, scratch);
  // Two beside each other, and two below these.
  fields.resize(std::min(fields.size(), most_maps));
  const bool two_rows = fields.size() > 2;
  body += "set multiplot\n" + axes;
  for (std::size_t n = 0; n < fields.size(); ++n) {
    const bool left = n % 2 == 0, above = two_rows && n < 2;
    const double x = left ? 0.09 : 0.545;
    const std::string bottom = above ? "((0.12+top)/2+0.035)" : "0.12",
                      top = two_rows && !above ? "((0.12+top)/2-0.035)" : "(top-0.01)";
    if (two_rows)
      body += fmt::format("set xlabel '{}'\nset format x '{}'\n", above && n + 2 < fields.size() ? "" : "space x",
                          above && n + 2 < fields.size() ? "" : "%h");
    body += fmt::format("set format y '{}'\n", left ? "%h" : "") +
            panel_tics(source.thinned.space().front(), source.thinned.space().back(), 0.345) +
            map_of(source, fields[n], frames,
                   {fmt::to_string(x), fmt::to_string(x + 0.345), bottom, top, top + "+0.03"}, scratch) +
            "unset label 104\n";
    if (n == 0) body += "unset label\n";  // title and axis are drawn once
  }
  return body + "unset multiplot\n";
}

}  // namespace delf
