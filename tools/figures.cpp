// SPDX-License-Identifier: MIT
#include "tools/figures.hpp"

#include <algorithm>
#include <numbers>

#include "tools/energy_figure.hpp"
#include "tools/figure_style.hpp"
#include "tools/gnuplot.hpp"
#include "tools/spacetime_figure.hpp"
#include "tools/text_file.hpp"
#include "tools/waveforms_figure.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

struct Figure {
  const char* name;
  std::string (*body)(const FigureSource&, const fs::path& scratch);  // empty: there is nothing to show
};
constexpr Figure all[] = {{"spacetime", spacetime_figure}, {"waveforms", waveforms_figure}, {"energy", energy_figure}};

}  // namespace

std::vector<double> drawn_space(const FigureSource& source) {
  std::vector<double> space = source.film.space();
  if (source.lattice.is_circle()) space.push_back(source.lattice.length());
  return space;
}

std::vector<double> drawn_frame(const FigureSource& source, int frame) {
  const auto row = source.film.frame(frame);
  const double unit = source.angle ? 2 * std::numbers::pi : 1;
  std::vector<double> values;
  for (const double value : row) values.push_back(std::clamp(value / unit, -1e30, 1e30));
  // φ(x + L) = φ(x) + 2π·winding
  if (source.lattice.is_circle()) values.push_back(values.front() + source.winding * 2 * std::numbers::pi / unit);
  return values;
}

int tame_frames(const FigureSource& source) {
  constexpr double much = 100;
  const auto span_of = [&](int frame) {
    const auto [least, most] = std::ranges::minmax(drawn_frame(source, frame));
    return most - least;
  };
  const double first = span_of(0);
  int tame = 1;
  while (tame < source.film.frames() && (first == 0 || span_of(tame) <= much * first)) ++tame;
  return tame;
}

std::vector<std::string> figure_names() {
  std::vector<std::string> names;
  for (const Figure& figure : all) names.emplace_back(figure.name);
  return names;
}

std::string draw_figures(const FigureSource& source, const fs::path& folder) {
  const ScratchFolder scratch(folder);
  std::string script;
  for (const Figure& figure : all)
    if (const std::string body = figure.body(source, scratch.path()); !body.empty())
      script += figure_script(figure.name, body);
  if (script.empty()) return {};
  write_text_file(scratch.path() / "script", script);
  if (const std::string wrong = run_gnuplot(scratch.path(), "script"); !wrong.empty()) return wrong;
  fs::create_directories(folder / "figures");
  for (const Figure& figure : all)
    for (const char* ending : {".png", ".svg"})
      if (const std::string file = std::string(figure.name) + ending; fs::exists(scratch.path() / file))
        fs::rename(scratch.path() / file, folder / "figures" / file);
  return {};
}

}  // namespace delf
