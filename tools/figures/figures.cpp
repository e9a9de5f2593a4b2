// SPDX-License-Identifier: MIT
#include "tools/figures/figures.hpp"

#include <algorithm>
#include <numbers>

#include "tools/figures/drawing.hpp"
#include "tools/figures/energy_figure.hpp"
#include "tools/figures/error_figure.hpp"
#include "tools/figures/figure_style.hpp"
#include "tools/figures/phase_figure.hpp"
#include "tools/figures/section_figure.hpp"
#include "tools/figures/spacetime_figure.hpp"
#include "tools/figures/spectrum_figure.hpp"
#include "tools/figures/trajectory_figure.hpp"
#include "tools/figures/waveforms_figure.hpp"
#include "tools/report/field_symbol.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

struct Figure {
  const char* name;
  std::string (*body)(const FigureSource&, const fs::path& scratch);  // empty: there is nothing to show
};
constexpr Figure all[] = {
    {"spacetime", spacetime_figure},   {"waveforms", waveforms_figure}, {"error", error_figure},
    {"trajectory", trajectory_figure}, {"orbit", orbit_figure},         {"phase", phase_figure},
    {"section", section_figure},       {"spectrum", spectrum_figure},   {"energy", energy_figure}};

}  // namespace

std::vector<double> drawn_space(const FigureSource& source) {
  if (source.names.drawn_mesh()) {
    constexpr int cells = 400;
    std::vector<double> even;
    for (int i = 0; i <= cells; ++i) even.push_back(source.lattice.length() * i / cells);
    return even;
  }
  std::vector<double> space = source.thinned.space();
  if (source.lattice.is_circle()) space.push_back(source.lattice.length());
  return space;
}

std::vector<double> drawn_sites(const FigureSource& source, int frame, std::size_t component) {
  const auto row = source.thinned.frame(frame);
  const double unit = source.angle && component != source.names.drawn_mesh() ? 2 * std::numbers::pi : 1;
  std::vector<double> values;
  for (std::size_t i = component; i < row.size(); i += source.thinned.components())
    values.push_back(std::clamp(row[i] / unit, -1e30, 1e30));
  // φ(x + L) = φ(x) + 2π·winding + gain
  if (source.lattice.is_circle())
    values.push_back(values.front() + (source.winding * 2 * std::numbers::pi + source.gain) / unit);
  return values;
}

std::vector<double> drawn_frame(const FigureSource& source, int frame, std::size_t component) {
  std::vector<double> values = drawn_sites(source, frame, component);
  if (!source.names.drawn_mesh() || component == *source.names.drawn_mesh()) return values;
  const std::vector<double> nodes = drawn_sites(source, frame, *source.names.drawn_mesh()), space = drawn_space(source);
  std::vector<double> there;
  for (const double x : space) {
    const auto after = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, x) - nodes.begin();
    const std::size_t b = after, a = b - 1;
    const double part = std::clamp((x - nodes[a]) / (nodes[b] - nodes[a]), 0.0, 1.0);
    there.push_back(values[a] + part * (values[b] - values[a]));
  }
  return there;
}

std::string drawn_name(const FigureSource& source, std::size_t component) {
  return field_symbol(source.names.drawn()[component]);
}

int tame_frames(const FigureSource& source) {
  constexpr double much = 100;
  const auto span_of = [&](int frame) {
    const auto [least, most] = std::ranges::minmax(drawn_frame(source, frame));
    return most - least;
  };
  const double first = span_of(0);
  int tame = 1;
  while (tame < source.thinned.frames() && (first == 0 || span_of(tame) <= much * first)) ++tame;
  return tame;
}

std::string subtitle(const FigureSource& source) {
  return source.theory + ", " + source.scheme +
         (source.thinned.is_aliased() ? "; frames too far apart for this motion: what moves may be an alias" : "");
}

std::vector<std::string> figure_names() {
  std::vector<std::string> names{"field", "levels", "updates", "film"};  // on a mesh, and of a film
  for (const Figure& figure : all) names.emplace_back(figure.name);
  return names;
}

std::string draw_figures(const FigureSource& source, const fs::path& folder) {
  std::vector<Drawing> drawings;
  for (const Figure& figure : all)
    drawings.push_back({figure.name, [&](const fs::path& scratch) { return figure.body(source, scratch); }});
  return draw(drawings, source.form, folder);
}

}  // namespace delf
