// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "lattice/index.hpp"
#include "schemes/methods/mesh_rows.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "tools/complex/drawn_mesh.hpp"
#include "tools/complex/mesh_files.hpp"
#include "tools/figures/drawing.hpp"
#include "tools/figures/figure_style.hpp"
#include "tools/files/text_file.hpp"
#include "tools/report/field_symbol.hpp"

namespace delf {
namespace {

namespace fs = std::filesystem;

constexpr int panels = 4;
constexpr int most_cells = 30'000;  // of a figure of triangles: ParaView opens what is larger

std::string title(const ComplexScene& c, const std::string& what) {
  return figure_title(fmt::format("{}: {}", c.scene.name, what),
                      fmt::format("{}, {} {}, {}", c.scene.problem.theory, c.sites(), c.stencils ? "sites" : "points",
                                  c.mesh_in_words()));
}

std::string shown_name(const ComplexScene& c, std::size_t field = 0) { return field_symbol(c.fields[field].name); }

double value_at(const ComplexScene& c, const MeshFilm::Frame& frame, std::size_t point, std::size_t field = 0) {
  return frame.values[point * c.fields.size() + field];
}

// The bar of colours beside maps, with what they show above it.
std::string colour_bar(const std::string& quantity) {
  return fmt::format(
      "set colorbox user origin screen 0.885,0.12 size screen 0.022,0.7 noborder\n"
      "set label 104 '{}' at screen 0.896,0.85 center textcolor rgb '#333333' noenhanced\n",
      quantity);
}

// Curves, in the order of positions: a mesh may number its points in any.
std::string curves(const ComplexScene& c, const MeshFilm& film, const fs::path& scratch) {
  const DrawnMesh drawn(c.space->mesh);
  const auto& points = drawn.points;
  std::vector<std::size_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, {}, [&](std::size_t i) { return points[i][0]; });
  std::string table, plot;
  for (std::size_t f = 0; f < film.frames().size(); ++f) {
    const MeshFilm::Frame& frame = film.frames()[f];
    for (const std::size_t i : order)
      table += fmt::format("{} {}\n", points[i][0], value_at(c, frame, at(drawn.of[i])));
    table += "\n\n";
    plot += fmt::format("{} 'curves' index {} using 1:2 with lines lw 1.6 lc rgb '{}' title '{}'",
                        f == 0 ? "plot" : ",", f, component_colour(f),
                        c.time == MeshTime::none ? shown_name(c) : fmt::format("t = {:.4g}", frame.time));
  }
  write_text_file(scratch / "curves", table);
  return title(c, shown_name(c) + (c.time == MeshTime::none ? "" : " at some times")) +
         fmt::format(
             "set lmargin at screen 0.105\nset rmargin at screen 0.97\nset bmargin at screen 0.12\n"
             "set tmargin at screen (top-0.05)\nset key at screen 0.97,(top-0.005) right top horizontal textcolor rgb "
             "'#333333'\n"
             "set grid lc rgb '#e4e4e4' lt 1 lw 0.7\nset xlabel 'space x'\nset ylabel '{}' noenhanced\n{}\n",
             shown_name(c), plot);
}

// A facet of gnuplot's surfaces; the third corner of a triangle stands twice.
void add_facet(std::string& table, std::span<const int> corners, const auto& corner) {
  corner(corners[0]), corner(corners[1]), table += "\n";
  corner(corners.back()), corner(corners[2]), table += "\n\n";
}

// One facet for each cell.
std::string maps(const ComplexScene& c, const Mesh& mesh, const MeshFilm& film, const fs::path& scratch) {
  if (mesh.cells() > most_cells) return {};
  const bool flat = mesh.coordinates() < 3;
  const DrawnMesh drawn(mesh);
  // One field at all times; of two or more the first two, in the beginning and in the end.
  struct Panel {
    const MeshFilm::Frame& frame;
    std::size_t field;
  };
  std::vector<Panel> all;
  const bool pair = c.fields.size() > 1 && !c.is_one_problem();
  for (const MeshFilm::Frame& frame : film.frames())
    if (!pair) all.push_back({frame, 0});
    else if (&frame == &film.frames().front() || &frame == &film.frames().back())
      all.push_back({frame, 0}), all.push_back({frame, 1});
  std::vector<double> shown;
  for (const Panel& panel : all)
    for (std::size_t i = 0; i < mesh.points.size(); ++i) shown.push_back(value_at(c, panel.frame, i, panel.field));
  const ColourScale scale = colour_scale(shown);
  const std::size_t count = all.size();
  std::string body =
      gnuplot_colours(scale) +
      title(c, (pair ? shown_name(c) + " and " + shown_name(c, 1) : shown_name(c)) +
                   (count == 1 ? "" : " at some times")) +
      fmt::format(
          "set pm3d {} corners2color mean\nunset key\nset border 0\nunset tics\nset cbtics {} scale 0.3\n"
          "set multiplot layout {},{} margins screen 0.03,0.86,0.04,(top-0.05) spacing screen 0.02,0.07\n{}",
          flat ? "map" : "depthorder", nice_step(scale.most - scale.least, 8), count > 2 ? 2 : 1, count > 1 ? 2 : 1,
          flat ? "set size ratio -1\n" : "set view 65,40,1.4\nset view equal xyz\n");
  for (std::size_t f = 0; f < count; ++f) {
    std::string table;
    const auto corner = [&](std::int32_t p) {
      const Mesh::Point& at = drawn.points[delf::at(p)];
      const double v = value_at(c, all[f].frame, delf::at(drawn.of[delf::at(p)]), all[f].field);
      table += flat ? fmt::format("{} {} {}\n", at[0], at[1], v) : fmt::format("{} {} {} {}\n", at[0], at[1], at[2], v);
    };
    for (int cell = 0; cell < mesh.cells(); ++cell) {
      const auto corners = drawn.cell(mesh, cell);
      add_facet(table, corners, corner);
    }
    const std::string file = fmt::format("map{}", f);
    write_text_file(scratch / file, table);
    // one scale for all, shown beside them once
    body += f == 0 ? colour_bar(pair ? "fields" : shown_name(c)) : "unset colorbox\nunset label\n";
    if (!c.is_one_problem())
      body += fmt::format("set title '{}t = {:.4g}' offset 0,0.1 textcolor rgb '#333333' noenhanced\n",
                          pair ? shown_name(c, all[f].field) + ", " : "", all[f].frame.time);
    body += fmt::format("splot '{}' using {} with pm3d\n", file, flat ? "1:2:3" : "1:2:3:4");
  }
  return body + "unset multiplot\n";
}

// The stencils of a finite complex over x and t, in the colour of their sites' values, or of the last of their sites' levels.
std::string spacetime(const ComplexScene& c, std::span<const double> values, std::span<const int> levels,
                      const fs::path& scratch) {
  if (c.cells() > most_cells) return {};
  const StencilList& list = *c.stencils;
  constexpr int most_with_edges = 6000;
  std::string table;
  std::vector<double> shown(values.begin(), values.end());
  for (const StencilList::Entry& e : list.stencils) {
    const std::vector<int> around = list.outline(e);
    if (around.size() < 3) continue;
    int level = -1;
    if (values.empty())
      for (const int s : around) level = std::max(level, levels[s]);
    const auto corner = [&](int s) {
      const auto& at = list.sites[s].position;
      table += fmt::format("{} {} {}\n", at[1], at[0], values.empty() ? level : values[delf::at(s) * c.fields.size()]);
    };
    if (values.empty()) shown.push_back(level);
    if (around.size() <= 4) add_facet(table, around, corner);
    else  // larger ones as triangles
      for (std::size_t l = 1; l + 1 < around.size(); ++l)
        add_facet(table, std::array{around[0], around[l], around[l + 1]}, corner);
  }
  if (table.empty()) return {};
  const std::string name = values.empty() ? "levels" : "field";
  write_text_file(scratch / name, table);
  const ColourScale scale =
      values.empty() ? ColourScale{0, std::max(1.0, *std::ranges::max_element(shown)), false} : colour_scale(shown);
  return gnuplot_colours(scale) +
         title(c, values.empty() ? "levels of the plan, in their order" : shown_name(c) + " on its stencils") +
         fmt::format(
             "set pm3d map corners2color {}\n{}unset key\nunset grid\nset lmargin at screen 0.105\n"
             "set rmargin at screen 0.86\nset bmargin at screen 0.12\nset tmargin at screen top\nset xlabel 'space x'\n"
             "set ylabel 'time t'\nset xrange [*:*] noextend\nset cbtics {} scale 0.3\n{}"
             "splot '{}' using 1:2:3 with "
             "pm3d\n",
             values.empty() ? "c1" : "mean",
             c.cells() <= most_with_edges ? "set pm3d border lc rgb '#808080' lw 0.3\n" : "",
             nice_step(scale.most - scale.least, 8), colour_bar(values.empty() ? "level" : shown_name(c)), name);
}

// A line from end to end of a segment at each time when it acts.
std::string updates(const ComplexScene& c, const fs::path& scratch) {
  constexpr double shown_steps = 8;
  constexpr std::int64_t most_lines = 20'000;
  const Mesh& mesh = c.space->mesh;
  const std::vector<double> steps = cell_steps(mesh, c.scene.problem.cell_courant);
  const double until = shown_steps * std::ranges::max(steps);
  std::string table;
  std::int64_t lines = 0;
  for (int cell = 0; cell < mesh.cells(); ++cell) {
    const double h = steps[cell];
    const double a = mesh.corner(cell, 0)[0], b = mesh.corner(cell, 1)[0];
    for (std::int64_t n = 0; static_cast<double>(n) * h <= until && lines < most_lines; ++n, ++lines)
      table += fmt::format("{} {} {} 0\n", a, static_cast<double>(n) * h, b - a);
  }
  if (lines == most_lines) return {};  // no eye would tell them apart
  write_text_file(scratch / "updates", table);
  return title(c, "when cells act, each by its own step") +
         fmt::format(
             "set lmargin at screen 0.105\nset rmargin at screen 0.97\nset bmargin at screen 0.12\n"
             "set tmargin at screen top\nset xlabel 'space x'\nset ylabel 'time t'\n"
             "plot 'updates' using 1:2:3:4 with vectors nohead lw 1 lc rgb '{}'\n",
             line_colour);
}

}  // namespace

MeshFilm::MeshFilm(const ComplexScene& c) : steps_(c.is_one_problem() ? 0 : c.scene.steps) {}

void MeshFilm::add(std::int64_t step, double time, std::span<const double> values) {
  // the first row at or after each third of the run
  const auto wanted = static_cast<std::int64_t>(frames_.size()) * steps_ / (panels - 1);
  if (static_cast<int>(frames_.size()) < panels && step >= wanted)
    frames_.push_back({step, time, {values.begin(), values.end()}});
}

void MeshFilm::visit(SavedState& state) {
  std::vector<std::int64_t> steps;
  std::vector<double> times, values;
  for (const Frame& f : frames_) {
    steps.push_back(f.step), times.push_back(f.time);
    values.insert(values.end(), f.values.begin(), f.values.end());
  }
  state("steps of frames", steps), state("times of frames", times), state("frames", values);
  if (!state.restores()) return;
  frames_.clear();
  const std::size_t size = steps.empty() ? 0 : values.size() / steps.size();
  for (std::size_t f = 0; f < std::min(steps.size(), times.size()); ++f)
    add(steps[f], times[f], std::span(values).subspan(f * size, size));
}

std::string draw_mesh(const ComplexScene& c, const MeshFilm& film, std::span<const int> levels,
                      const fs::path& folder) {
  if (film.frames().empty()) return {};
  const auto of_many = [&] {
    return fmt::format("the {} has more than {} cells{}", c.stencils ? "complex" : "mesh", most_cells,
                       has_xdmf(c) ? "; open fields.xdmf in ParaView" : "");
  };
  if (c.stencils) {
    if (c.coordinates() > 2)
      return fmt::format("a complex of {} coordinates has no figure in the plane{}", c.coordinates(),
                         has_xdmf(c) ? "; open fields.xdmf in ParaView" : "");
    if (c.cells() > most_cells) return of_many();
    return draw({{"field", [&](const fs::path& to) { return spacetime(c, film.frames().front().values, {}, to); }},
                 {"levels", [&](const fs::path& to) { return spacetime(c, {}, levels, to); }}},
                c.scene.figure_form, folder);
  }
  const Mesh& mesh = c.space->mesh;
  const bool line = mesh.coordinates() == 1;
  std::vector<Drawing> drawings{{"field", [&](const fs::path& scratch) {
                                   return line ? curves(c, film, scratch) : maps(c, mesh, film, scratch);
                                 }}};
  if (c.time == MeshTime::cells && line)
    drawings.push_back({"updates", [&](const fs::path& scratch) { return updates(c, scratch); }});
  const std::string missing = draw(drawings, c.scene.figure_form, folder);
  if (missing.empty() && !line && mesh.cells() > most_cells) return of_many();
  return missing;
}

}  // namespace delf
