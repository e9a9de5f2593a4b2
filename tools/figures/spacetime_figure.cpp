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
  const std::size_t sites = source.film.space().size(), apart = (sites + most - 1) / most;
  std::string table;
  for (std::size_t i = 0; i < sites; i += apart) {
    for (int f = 0; f < frames; ++f)
      table += fmt::format("{} {}\n", drawn_sites(source, f, *mesh)[i], source.film.time(f));
    table += "\n";
  }
  write_text_file(scratch / "paths", table);
  // A light line on a dark one is seen on any colour of the map.
  return ", 'paths' using 1:2 with lines lw 1.5 lc rgb '#90202020', 'paths' using 1:2 with lines lw 0.6 lc rgb '#40ffffff'";
}

}  // namespace

std::string spacetime_figure(const FigureSource& source, const std::filesystem::path& scratch) {
  const Film& film = source.film;
  std::vector<double> space = drawn_space(source);
  const int frames = film.even_frames();
  if (frames < 2 || film.space().size() < 2) return {};
  // a thinned circle may not close after a full interval: then the last column stays away
  const double dx = space[1] - space[0];
  if (space.back() - space[space.size() - 2] < 0.99 * dx) space.pop_back();

  std::vector<double> map;
  for (int f = 0; f < frames; ++f) {
    const auto frame = drawn_frame(source, f);
    map.insert(map.end(), frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(space.size()));
  }
  // an angle that has drifted by many multiples of 2π is shown by its distance from the vacua
  const auto tame = std::span(map).first(space.size() * at(std::min(frames, tame_frames(source))));
  const auto [least, most] = std::ranges::minmax(tame);
  const bool drifts = source.angle && most - least > 8;
  const std::string name = drawn_name(source, 0);
  const std::string quantity = drifts ? "sin²(" + name + "/2)" : source.angle ? name + " / 2π" : name;
  const std::string shown = film.components() == 1 ? "the field" : name;
  if (drifts)
    std::ranges::transform(map, map.begin(),
                           [](double turns) { return std::pow(std::sin(std::numbers::pi * turns), 2); });
  write_text_file(scratch / "map", {reinterpret_cast<const char*>(map.data()), map.size() * sizeof(double)});

  const ColourScale scale = colour_scale(tame);
  const double t0 = film.time(0), t1 = film.time(frames - 1), dt = (t1 - t0) / (frames - 1);
  return gnuplot_colours(scale) +
         figure_title(fmt::format("{}: {} over space and time", source.scene, shown), subtitle(source)) +
         fmt::format(
             "set lmargin at screen 0.105\nset rmargin at screen 0.855\n"
             "set bmargin at screen 0.12\nset tmargin at screen top\n"
             "set xlabel 'space x'\nset label 103 'time t' at screen 0.025,0.4875 center rotate textcolor rgb "
             "'#333333'\n"
             "set label 104 '{}' at screen 0.886,(top+0.03) center textcolor rgb '#333333' noenhanced\n"
             "set border 15\nset colorbox user origin screen 0.875,0.12 size screen 0.022,(top-0.12) noborder\n"
             "set cbtics {} scale 0.3\nset xrange [{}:{}]\nset yrange [{}:{}]\n"
             "plot 'map' binary array=({},{}) dx={} dy={} origin=({},{}) format='%double' using 1 with image{}\n",
             quantity, nice_step(scale.most - scale.least, 8), space.front() - dx / 2, space.back() + dx / 2,
             t0 - dt / 2, t1 + dt / 2, space.size(), frames, dx, dt, space.front(), t0,
             site_paths(source, frames, scratch));
}

}  // namespace delf
