// SPDX-License-Identifier: MIT
#include "tools/film/film_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>

#include "schemes/monodromy.hpp"
#include "tools/figures/figure_style.hpp"
#include "tools/figures/gnuplot.hpp"
#include "tools/files/text_file.hpp"
#include "tools/film/painted_cells.hpp"
#include "tools/rows/initial_rows.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

constexpr auto grid = "set grid lc rgb '#e4e4e4' lt 1 lw 0.7\n";
constexpr auto pale = "#c4c4c4";

std::string range_of(const char* axis, double least, double most) {
  const double room = 0.06 * (most - least);
  return fmt::format("set {}range [{}:{}]\n", axis, least - room, most + room);
}

/// The scale of all values of a film, unless a few would flatten the others thirtyfold.
ColourScale scale_of(const std::vector<double>& values) {
  const ColourScale most_of_them = colour_scale(values);
  std::vector<double> ends;
  for (const double v : values)
    if (!std::isfinite(v)) continue;
    else if (ends.empty()) ends = {v, v};
    else ends = {std::min(ends[0], v), std::max(ends[1], v)};
  constexpr double flattened = 30;
  const bool all = !ends.empty() && ends[1] - ends[0] <= flattened * (most_of_them.most - most_of_them.least);
  return all ? colour_scale(ends) : most_of_them;
}

/// The range that all of some values need, but for a few that would flatten the others.
std::string range_of(const char* axis, const std::vector<double>& values) {
  const ColourScale scale = scale_of(values);
  return range_of(axis, scale.least, scale.most);
}

/// Margins within the panel, in the middle of it, so that both axes have one unit.
std::string same_unit(const Panel& panel, double width, double height) {
  const double unit =
      std::min((panel.right - panel.left) * frame_width / width, (panel.top - panel.bottom) * frame_height / height);
  const double x = (panel.left + panel.right) / 2, y = (panel.bottom + panel.top) / 2,
               dx = unit * width / frame_width / 2, dy = unit * height / frame_height / 2;
  return fmt::format(
      "set lmargin at screen {}\nset rmargin at screen {}\nset bmargin at screen {}\nset tmargin at screen {}\n",
      x - dx, x + dx, y - dy, y + dy);
}

/// The names of the curves in their colours, above the panel.
std::string names_of(const std::vector<std::string>& names) {
  std::string labels;
  if (names.size() < 2) return labels;
  for (std::size_t c = 0; c < std::min(names.size(), line_colours); ++c)
    labels += fmt::format("set label {} {} at graph {},1.03 left textcolor rgb '{}' noenhanced\n", 110 + c,
                          gnuplot_quoted(names[c]), 0.08 * static_cast<double>(c), component_colour(c));
  return labels;
}

/// The exact solution of a scene, where its state is one; kept with the rows that know it.
struct Solution {
  explicit Solution(const Scene& scene) : rows(scene) {}
  InitialRows rows;
};
std::shared_ptr<Solution> solution_of(const AnyScene& scene) try {
  const auto* lattice = std::get_if<Scene>(&scene);
  auto solution = lattice && !lattice->from_file() ? std::make_shared<Solution>(*lattice) : nullptr;
  return solution && solution->rows.exact() ? solution : nullptr;
} catch (const BadInput&) {
  return nullptr;
}

/// The curves of a frame: x, then the values of each field there, in units of 2π of an angle.
struct Curves {
  std::vector<double> x;
  std::vector<std::vector<double>> fields;
};

Curves curves_of(const FilmRows& rows, std::size_t frame) {
  constexpr std::size_t most_points = 1500;  // more than pixels
  const double unit = rows.is_angle() ? 2 * std::numbers::pi : 1;
  Curves curves{rows.places(frame), {}};
  for (const std::size_t c : rows.fields()) {
    curves.fields.push_back(rows.component(frame, c));
    for (double& value : curves.fields.back()) value /= unit;
  }
  if (const auto* lattice = std::get_if<Scene>(&rows.scene())) {
    if (lattice->problem.lattice.is_circle()) {  // φ(x + L) = φ(x) + 2π·winding + gain
      const double gain =
          2 * std::numbers::pi * rows.reader().winding().value_or(0) + gain_of(lattice->problem.parameters);
      curves.x.push_back(curves.x.front() + lattice->problem.lattice.length());
      for (auto& field : curves.fields) field.push_back(field.front() + gain / unit);
    }
  } else {  // a mesh may number its points in any order
    std::vector<std::size_t> order(curves.x.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, {}, [&](std::size_t i) { return curves.x[i]; });
    const auto sorted = [&](const std::vector<double>& values) {
      std::vector<double> there;
      for (const std::size_t i : order) there.push_back(values[i]);
      return there;
    };
    curves.x = sorted(curves.x);
    for (auto& field : curves.fields) field = sorted(field);
  }
  const std::size_t apart = (curves.x.size() + most_points - 1) / most_points;
  const auto thin = [&](std::vector<double>& values) {
    std::vector<double> some;
    for (std::size_t i = 0; i < values.size(); i += apart) some.push_back(values[i]);
    values = std::move(some);
  };
  if (apart > 1) {
    thin(curves.x);
    for (auto& field : curves.fields) thin(field);
  }
  return curves;
}

FilmView curves_view(const FilmRows& rows, const fs::path&) {
  std::vector<double> all;
  double left = std::numeric_limits<double>::infinity(), right = -left;
  for (std::size_t n = 0; n < rows.frames(); ++n) {
    const Curves curves = curves_of(rows, n);
    const auto [low, high] = std::ranges::minmax(curves.x);
    left = std::min(left, low), right = std::max(right, high);
    for (const auto& field : curves.fields) all.insert(all.end(), field.begin(), field.end());
  }
  const bool moves = rows.frames() > 1 && rows.places(0) != rows.places(rows.frames() - 1);
  const std::string name =
      (rows.symbols().size() == 1 ? rows.symbols()[0] : "fields") + (rows.is_angle() ? " / 2π" : "");
  const std::string axes = fmt::format("set xrange [{}:{}]\n{}set xlabel 'space x'\nset ylabel {} noenhanced\n{}", left,
                                       right, range_of("y", all), gnuplot_quoted(name), grid) +
                           names_of(rows.symbols());
  const auto solution = solution_of(rows.scene());
  const auto draw = [&rows, axes, moves, solution, left, right](std::size_t n, const fs::path& scratch) {
    const Curves curves = curves_of(rows, n);
    std::string table;
    for (std::size_t i = 0; i < curves.x.size(); ++i) {
      table += fmt::format("{:.7g}", curves.x[i]);
      for (const auto& field : curves.fields) table += fmt::format(" {:.7g}", field[i]);
      table += "\n";
    }
    write_text_file(scratch / fmt::format("rows{}", n), table);
    std::string plot = "plot ";
    if (const State* exact = solution ? solution->rows.exact() : nullptr;
        exact && rows.time(n) <= exact->exact_until()) {
      constexpr int points = 500;
      const double unit = rows.is_angle() ? 2 * std::numbers::pi : 1;
      std::vector<FieldPoint> here(at(exact->components()));
      std::string grey;
      for (int i = 0; i <= points; ++i) {
        const double x = left + (right - left) * i / points;
        exact->at(rows.time(n), x, here);
        grey += fmt::format("{:.7g}", x);
        for (const FieldPoint& point : here) grey += fmt::format(" {:.7g}", point.phi / unit);
        grey += "\n";
      }
      write_text_file(scratch / fmt::format("exact{}", n), grey);
      for (std::size_t a = 0; a < std::min(here.size(), curves.fields.size()); ++a)
        plot += fmt::format("'exact{}' using 1:{} with lines lw 5 lc rgb '{}', ", n, a + 2, pale);
    }
    for (std::size_t c = 0; c < curves.fields.size(); ++c)
      plot += fmt::format("{}'rows{}' using 1:{} with {} lw 2 lc rgb '{}'", c == 0 ? "" : ", ", n, c + 2,
                          moves ? "linespoints pt 7 ps 0.7" : "lines", component_colour(c));
    return axes + plot + "\n";
  };
  return {fmt::format("the field{} over space{}{}", rows.symbols().size() == 1 ? "" : "s",
                      solution ? "; grey: the exact solution" : "", moves ? "; dots: the sites" : ""),
          draw};
}

FilmView map_view(const FilmRows& rows, const Mesh& mesh, Panel panel) {
  constexpr int longer_side = 480;
  const auto cells = std::make_shared<const PaintedCells>(mesh, longer_side);
  std::vector<double> all;
  constexpr std::size_t most_values = 4'000'000;  // for a scale
  const std::size_t apart = rows.frames() * mesh.points.size() / most_values + 1;
  for (std::size_t n = 0; n < rows.frames(); n += apart) {
    const std::vector<double> values = rows.component(n, 0);
    all.insert(all.end(), values.begin(), values.end());
  }
  const ColourScale scale = scale_of(all);
  const bool flat = mesh.coordinates() < 3;
  const auto [x0, y0] = cells->low();
  const auto [x1, y1] = cells->high();
  panel.right -= 0.07;  // room for the bar of colours
  const std::string axes =
      gnuplot_colours(scale) + same_unit(panel, x1 - x0, y1 - y0) +
      fmt::format(
          "set xrange [{}:{}]\nset yrange [{}:{}]\nset cbtics {} scale 0.3\nset label 104 {} at graph "
          "1.02,1.03 left noenhanced\nset colorbox noborder\n{}",
          x0, x1, y0, y1, nice_step(scale.most - scale.least, 8), gnuplot_quoted(rows.symbols()[0]),
          flat ? "set xlabel 'x'\nset ylabel 'y'\nset border 15\n"
               : "unset border\nunset xtics\nunset ytics\nunset xlabel\nunset ylabel\n");
  const double dx = (x1 - x0) / cells->width(), dy = (y1 - y0) / cells->height();
  const auto draw = [&rows, axes, cells, dx, dy](std::size_t n, const fs::path& scratch) {
    const std::vector<float> picture = cells->values(rows.component(n, 0));
    write_text_file(scratch / fmt::format("map{}", n),
                    {reinterpret_cast<const char*>(picture.data()), picture.size() * sizeof(float)});
    return axes +
           fmt::format(
               "plot 'map{}' binary array=({},{}) dx={} dy={} origin=({},{}) format='%float' using 1 with image\n", n,
               cells->width(), cells->height(), dx, dy, cells->low()[0] + dx / 2, cells->low()[1] + dy / 2);
  };
  return {fmt::format("{} on its mesh", rows.symbols()[0]), draw};
}

/// The names of coordinates, as figures have them.
std::vector<std::string> coordinates_of(const FilmRows& rows) {
  std::vector<std::string> names = rows.symbols();
  for (std::size_t c = 0; c < names.size(); ++c)
    if (names[c].starts_with("φ")) names[c] = names.size() == 1 ? "q" : fmt::format("q{}", c + 1);
  return names;
}

/// Two columns of a table of points over each other, the way up to now dark, and where it is.
FilmView path_view(const FilmRows& rows, const fs::path& scratch, const Panel* same,
                   const std::vector<std::vector<double>>& points, const std::vector<std::string>& names,
                   const std::string& about) {
  std::string table;
  for (std::size_t n = 0; n < rows.all_times().size(); ++n) {
    table += fmt::format("{}", rows.all_times()[n]);
    for (const auto& values : points) table += fmt::format(" {}", values[n]);
    table += "\n";
  }
  write_text_file(scratch / "path", table);
  const bool in_space = points.size() == 3;
  std::string axes = grid;
  for (std::size_t a = 0; a < points.size(); ++a) {
    const char* axis = std::array{"x", "y", "z"}[a];
    axes += range_of(axis, points[a]) + fmt::format("set {}label {} noenhanced\n", axis, gnuplot_quoted(names[a]));
    const ColourScale scale = scale_of(points[a]);
    if (points.size() == 3) axes += fmt::format("set {}tics {}\n", axis, nice_step(scale.most - scale.least, 4));
  }
  if (in_space) axes += "set view 65,40\nset view equal xyz\nset xyplane 0\nset border 4095 lc rgb '#999999'\n";
  else if (same) {
    const auto range = [&](const std::vector<double>& values) {
      const ColourScale scale = scale_of(values);
      return scale.most - scale.least;
    };
    axes += same_unit(*same, range(points[0]), range(points[1]));
  }
  const auto draw = [&rows, axes, in_space](std::size_t frame, const fs::path&) {
    const std::size_t n = rows.recorded_until(frame) - 1;
    const std::string rest = in_space ? "3:4" : "3";
    return axes +
           fmt::format(
               "{0} 'path' using 2:{1} with lines lw 1.5 lc rgb '{2}', 'path' every ::::{3} using 2:{1} with lines lw 2 "
               "lc rgb '{4}', 'path' every ::{3}::{3} using 2:{1} with points pt 7 ps 2 lc rgb '{5}'\n",
               in_space ? "splot" : "plot", rest, pale, n, line_colour, component_colour(1));
  };
  return {about, draw};
}

FilmView coordinates_view(const FilmRows& rows, const fs::path& scratch, const std::vector<std::string>& names) {
  std::string table;
  std::vector<double> all;
  const std::size_t d = std::min(names.size(), line_colours);
  const double unit = rows.is_angle() ? 2 * std::numbers::pi : 1;
  for (std::size_t n = 0; n < rows.all_times().size(); ++n) {
    const std::vector<double> row = rows.recorded_row(n);
    table += fmt::format("{}", rows.all_times()[n]);
    for (std::size_t c = 0; c < d; ++c) {
      all.push_back(row[rows.fields()[c]] / unit);
      table += fmt::format(" {}", all.back());
    }
    table += "\n";
  }
  write_text_file(scratch / "path", table);
  const std::vector<std::string> shown(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(d));
  const std::string axes =
      fmt::format("set xrange [{}:{}]\n{}set xlabel 'time t'\nset ylabel {} noenhanced\n{}", rows.time(0),
                  rows.time(rows.frames() - 1), range_of("y", all),
                  gnuplot_quoted((d == 1 ? names[0] : "coordinates") + (rows.is_angle() ? " / 2π" : "")), grid) +
      names_of(shown);
  const auto draw = [&rows, axes, d](std::size_t frame, const fs::path&) {
    const std::size_t n = rows.recorded_until(frame) - 1;
    std::string plot = "plot ";
    for (std::size_t c = 0; c < d; ++c)
      plot += fmt::format("{0}'path' using 1:{1} with lines lw 1.2 lc rgb '{2}'", c == 0 ? "" : ", ", c + 2, pale);
    for (std::size_t c = 0; c < d; ++c)
      plot += fmt::format(
          ", 'path' every ::::{0} using 1:{1} with lines lw 2 lc rgb '{2}', 'path' every ::{0}::{0} using 1:{1} with points "
          "pt 7 ps 1.6 lc rgb '{2}'",
          n, c + 2, component_colour(c));
    return axes + plot + "\n";
  };
  return {names.size() > d ? fmt::format("the first {} of {} coordinates over time", d, names.size())
          : d == 1         ? "the coordinate over time"
                           : "the coordinates over time",
          draw};
}

FilmView point_view(const FilmRows& rows, const Panel& panel, const fs::path& scratch) {
  const std::vector<std::string> names = coordinates_of(rows);
  const std::size_t d = names.size();
  if (d == 2 || d == 3) {
    std::vector<std::vector<double>> points(d);
    for (std::size_t n = 0; n < rows.all_times().size(); ++n) {
      const std::vector<double> row = rows.recorded_row(n);
      for (std::size_t c = 0; c < d; ++c) points[c].push_back(row[rows.fields()[c]]);
    }
    return path_view(rows, scratch, &panel, points, names, "the orbit");
  }
  if (d == 1 && rows.recorded_momenta(0)) {
    std::vector<std::vector<double>> points(2);
    const double unit = rows.is_angle() ? 2 * std::numbers::pi : 1;
    for (std::size_t n = 0; n < rows.all_times().size(); ++n) {
      const auto p = rows.recorded_momenta(n);
      points[0].push_back(rows.recorded_row(n)[0] / unit);
      points[1].push_back(p ? p->front() : std::numeric_limits<double>::quiet_NaN());
    }
    return path_view(rows, scratch, nullptr, points, {names[0] + (rows.is_angle() ? " / 2π" : ""), "p"},
                     "the phase portrait");
  }
  return coordinates_view(rows, scratch, names);
}

}  // namespace

FilmView film_view(const FilmRows& rows, const Panel& panel, const fs::path& scratch) {
  if (const auto* mesh = std::get_if<ComplexScene>(&rows.scene()))
    return mesh->space->mesh.coordinates() > 1 ? map_view(rows, mesh->space->mesh, panel) : curves_view(rows, scratch);
  return rows.common().problem.lattice.space() == Space::point ? point_view(rows, panel, scratch)
                                                               : curves_view(rows, scratch);
}

}  // namespace delf
