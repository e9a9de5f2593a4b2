// SPDX-License-Identifier: MIT
#include "tools/sweep/compared_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/read_number.hpp"
#include "lattice/text_parts.hpp"
#include "tools/compare/field_error.hpp"
#include "tools/complex/complex_scene.hpp"
#include "tools/figures/figure_style.hpp"
#include "tools/figures/gnuplot.hpp"
#include "tools/files/fields_reader.hpp"
#include "tools/files/text_file.hpp"
#include "tools/report/text_columns.hpp"
#include "tools/rows/initial_rows.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_points = 1000;

// The columns time and energy_error of series.csv.
Course energy_error_of(const fs::path& series) {
  Course course;
  std::ifstream in(series);
  std::string line;
  if (!std::getline(in, line)) return course;
  const std::vector<std::string> names = parts_of(line);
  const auto column = [&](const char* name) { return at(std::ranges::find(names, name) - names.begin()); };
  const std::size_t time = column("time"), error = column("energy_error");
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = parts_of(line);
    if (cells.size() <= std::max(time, error)) continue;
    const auto t = read_finite(cells[time]), value = read_finite(cells[error]);
    if (t && value) course.times.push_back(*t), course.values.push_back(*value);
  }
  return course;
}

Course error_of(const Scene& scene, const fs::path& fields) {
  Course course;
  std::error_code none;
  if (is_on_mesh(scene.settings) || scene.from_file() || !fs::exists(fields, none)) return course;
  try {
    const InitialRows initial(scene);
    const State* exact = initial.exact();
    const FieldsReader rows(fields);
    if (!exact || rows.components() != exact->components() || rows.sites() != scene.problem.lattice.sites())
      return course;
    const int apart = 1 + rows.frames() / static_cast<int>(most_points);
    std::vector<double> solution(at(rows.sites()) * at(rows.components()));
    for (int frame = 0; frame < rows.frames(); frame += apart) {
      const auto t = rows.time(frame);
      if (!t || *t > exact->exact_until()) continue;
      exact->values(*t, scene.problem.lattice, solution);
      const double error = field_error(rows.row(frame), solution, scene.problem.lattice.space_step()).linf;
      if (std::isfinite(error)) course.times.push_back(*t), course.values.push_back(error);
    }
  } catch (const Error&) {  // rows that are damaged, or not finite, are no curve
  }
  return course;
}

/// One plot of a course of each run, over time.
class Panel {
 public:
  Panel(const std::vector<ComparedRun>& runs, Course ComparedRun::*course) : runs_(runs), course_(course) {
    for (const ComparedRun& run : runs) {
      double largest = 0;
      for (const double value : (run.*course).values) largest = std::max(largest, std::abs(value));
      if (largest > 0) largest_.push_back(largest);
    }
  }
  bool empty() const { return largest_.empty(); }

  /// On a logarithmic axis where the runs differ by more than a factor of 30; else with their signs.
  std::string script(const std::string& name, const std::string& label, const std::string& magnitude,
                     const fs::path& scratch) const {
    constexpr double far = 30;
    const auto [least, most] = std::ranges::minmax(largest_);
    const bool wide = most > far * least, plain = most > 0.01 && most < 1000;
    const double power = plain ? 0 : std::floor(std::log10(most)), unit = std::pow(10, power);
    std::string plots, table;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      const auto& [times, values] = runs_[r].*course_;
      table += fmt::format("# {}\n", r);
      for (std::size_t i = 0; i < times.size(); ++i)
        if (!wide || values[i] != 0)
          table += fmt::format("{} {}\n", times[i], wide ? std::abs(values[i]) : values[i] / unit);
      if (table.ends_with("# " + fmt::to_string(r) + "\n")) table += "NaN NaN\n";
      table += "\n\n";
      constexpr std::size_t colours = 6;
      plots += fmt::format("{}'{}' index {} using 1:2 with lines lw 1.2 dt {} lc rgb '{}' title {} noenhanced",
                           r == 0 ? "plot " : ", ", name, r, 1 + r / colours, component_colour(r),
                           gnuplot_quoted(runs_[r].words));
    }
    write_text_file(scratch / name, table);
    const auto quoted = [&](const std::string& text) { return "set ylabel '" + text + "' font ',10\n"; };
    return wide ? "set logscale y\nset format y '10^{%T}'\n" + quoted(magnitude) + plots + "\n"
                : "unset logscale y\nset format y '%h'\n" +
                      quoted(plain ? label : fmt::format("{}   (10^{{{}}})", label, power)) + plots + "\n";
  }

 private:
  const std::vector<ComparedRun>& runs_;
  Course ComparedRun::*course_;
  std::vector<double> largest_;
};

}  // namespace

ComparedRun compared_run(const std::string& words, const Scene& scene, const fs::path& folder) {
  return {words, energy_error_of(folder / "series.csv"), error_of(scene, folder / "fields.h5")};
}

std::string compared_runs_figure(const std::vector<ComparedRun>& all, const fs::path& scratch) {
  std::vector<ComparedRun> runs;  // those that left something
  std::ranges::copy_if(all, std::back_inserter(runs), [](const ComparedRun& run) {
    return !run.energy_error.values.empty() || !run.error.values.empty();
  });
  const Panel energies(runs, &ComparedRun::energy_error), errors(runs, &ComparedRun::error);
  if (energies.empty() && errors.empty()) return {};
  std::size_t longest = 0;
  for (const ComparedRun& run : runs) longest = std::max(longest, columns_of(run.words));
  const double right = 1 - std::clamp(0.085 + 0.009 * static_cast<double>(longest), 0.12, 0.4);
  const bool both = !energies.empty() && !errors.empty();
  std::string script = fmt::format(
      "set multiplot\nset lmargin at screen 0.125\nset rmargin at screen {}\nset xrange [0:*]\n"
      "set grid lc rgb '#e4e4e4' lt 1 lw 0.7\n"
      "set key at screen 0.985,(titles ? 0.855 : 0.935) right top vertical samplen 1.6 spacing 1.2 font ',10' "
      "textcolor rgb '#333333'\n",
      right);
  if (!energies.empty()) {
    script += fmt::format("set tmargin at screen top\nset bmargin at screen {}\n", both ? 0.53 : 0.13);
    script += both ? "set format x ''\n" : "set xlabel 'time t'\n";
    script += energies.script("energies", "(E − E_0) / |E_0|", "|E − E_0| / |E_0|", scratch);
  }
  if (!errors.empty()) {
    script += "set format x '%h'\nset xlabel 'time t'\nset bmargin at screen 0.13\n";
    if (both) script += "unset key\nset tmargin at screen 0.49\n";
    else script += "set tmargin at screen top\n";
    script += errors.script("errors", "max |φ − φ_{exact}|", "max |φ − φ_{exact}|", scratch);
  }
  return script + "unset multiplot\n";
}

}  // namespace delf
