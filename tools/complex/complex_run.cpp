// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>

#include "jets/fibre.hpp"
#include "schemes/complex/asynchronous.hpp"
#include "tools/complex/complex_commands.hpp"
#include "tools/complex/mesh_figures.hpp"
#include "tools/complex/mesh_files.hpp"
#include "tools/complex/mesh_summary.hpp"
#include "tools/complex/row_steps.hpp"
#include "tools/complex/static_field.hpp"
#include "tools/files/folder_lock.hpp"
#include "tools/files/series_file.hpp"
#include "tools/run/earlier_run.hpp"
#include "tools/run/interrupt.hpp"
#include "tools/run/progress.hpp"
#include "tools/run/seconds_since.hpp"
#include "tools/scene/text_file.hpp"

namespace delf {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// The largest error, and √(Σ A_i e_i²); of sites without masses √(Σ e²/sites).
void measure_error(const ComplexScene& c, std::span<const double> values, double t, Outcome& o) {
  if (!c.has_solution()) return;
  const std::vector<double> exact = c.solution(t);
  const std::size_t d = c.fields.size();
  o.error_linf = 0;
  double sum = 0;
  for (std::size_t n = 0; n < exact.size(); ++n) {
    const double apart = values[n] - exact[n];
    const double error = std::abs(c.scene.problem.circle_valued ? wrap(apart) : apart);
    o.error_linf = std::max(o.error_linf, error);
    sum += (c.space ? c.space->masses[n / d] : 1 / static_cast<double>(c.sites())) * error * error;
  }
  o.error_l2 = std::sqrt(sum);
}

/// What a run writes, row by row.
class MeshRecorder {
 public:
  MeshRecorder(const ComplexScene& c, const fs::path& folder, std::int64_t frames, Outcome& outcome)
      : c_(c), outcome_(outcome), film_(c), series_(folder / "series.csv", std::vector<std::string>{}) {
    if (c.scene.fields) files_.emplace(c, folder, frames, c.time == MeshTime::cells);
  }
  void record(std::int64_t row, double time, std::span<const double> values, double energy, int iterations,
              double residual, std::span<const double> node_times = {}) {
    Outcome& o = outcome_;
    if (!c_.stencils && !std::isfinite(energy))
      throw NotFinite(
          fmt::format("row {}, t = {:.6g}: the energy is not finite; use smaller fields or steps", row, time));
    if (c_.stencils)
      for (std::size_t n = 0; n < values.size(); ++n)
        if (!std::isfinite(values[n])) throw NotFinite("a value is not finite; use smaller data, or a finer complex");
    if (o.records++ == 0) o.energy_initial = energy;
    o.energy_final = energy;
    const double error =
        o.energy_initial == 0 ? Outcome::unknown : std::abs(energy - o.energy_initial) / std::abs(o.energy_initial);
    if (!(error <= o.energy_error_max)) o.energy_error_max = error;
    if (std::isfinite(residual)) o.residual_max = std::max(o.residual_max, residual);
    else if (c_.time == MeshTime::cells) o.residual_max = residual;  // of asynchronous steps it is not measured
    series_.append({row, time, energy, error, Outcome::unknown, Outcome::unknown, iterations, residual, {}});
    if (files_) files_->append(time, values, node_times);
    if (c_.scene.figures) film_.add(row, time, values);
  }
  const MeshFilm& film() const { return film_; }
  void close() {
    series_.close();
    if (files_) files_->close();
  }

 private:
  const ComplexScene& c_;
  Outcome& outcome_;
  MeshFilm film_;
  SeriesFile series_;
  std::optional<MeshFiles> files_;
};

void run_static(const ComplexScene& c, MeshRecorder& recorder, Outcome& o) {
  StaticField field(c);
  o.solve = field.solver().plan().describe();
  o.solve_kind = field.solver().plan().largest == 1 ? "explicit" : "sparse";
  o.bytes = field.system().bytes();
  const auto begin = Clock::now();
  const ComplexSolver::Report solved = field.solve();
  o.seconds = seconds_since(begin);
  o.iterations_mean = o.iterations_max = solved.iterations;
  if (solved.undetermined > 0)
    o.warnings.push_back(
        fmt::format("the equations hold to rounding, and hardly change in one direction: along it the values are known "
                    "to {:.2g} of themselves only",
                    solved.undetermined));
  recorder.record(0, 0, field.values(), c.stencils ? Outcome::unknown : field.energy(), solved.iterations,
                  field.residual());
  measure_error(c, field.values(), 0, o);
}

void run_rows(const ComplexScene& c, MeshRecorder& recorder, MeshOutcome& o) {
  SpaceEvolution evolution(*c.space, c.time_step(0), {c.scene.problem.tolerance, c.scene.problem.max_iterations});
  o.solve = evolution.plan().describe() + (evolution.is_direct() ? " (explicit)" : "");
  o.solve_kind = evolution.is_direct() ? "explicit" : "sparse";
  o.bytes = evolution.bytes();
  if (const auto most = evolution.largest_step(); most && *most < c.scene.problem.time_step)
    o.warnings.push_back(fmt::format("waves on this mesh grow at h = {:.4g} by linear theory; take h below {:.4g}",
                                     c.scene.problem.time_step, *most));
  const std::vector<double> start = c.values();
  RowSteps row_steps(c);
  row_steps.start(evolution);
  Progress progress(c.scene.steps);
  const auto is_over = [&] { return c.is_over(evolution.newest(), evolution.time()); };
  const auto is_recorded = [&] { return is_over() || (c.scene.every > 0 && evolution.newest() % c.scene.every == 0); };
  const auto note_step = [&] {
    if (c.time_steps.empty() && !c.step_control) return;
    const double h = evolution.last_step();
    o.longest = std::max(o.longest, h);
    o.shortest = o.shortest == 0 ? h : std::min(o.shortest, h);
  };
  note_step();
  const auto record = [&] {
    recorder.record(evolution.newest(), evolution.time(), evolution.row(), evolution.energy(),
                    evolution.report().iterations, evolution.residual());
  };
  if (c.scene.every > 0 || c.scene.steps == 0) recorder.record(0, 0, start, evolution.energy(), 0, 0);
  if (c.scene.steps > 0 && is_recorded()) record();
  double iterations = 0;
  while (!is_over() && !Interrupt::asked()) {
    std::int64_t last = evolution.newest() + 256;
    if (c.scene.every > 0) last = std::min(last, (evolution.newest() / c.scene.every + 1) * c.scene.every);
    const auto begin = Clock::now();
    while (evolution.newest() < last && !is_over()) {
      row_steps.step(evolution);
      note_step();
      iterations += evolution.report().iterations;
      o.iterations_max = std::max(o.iterations_max, evolution.report().iterations);
      ++o.steps_taken;
    }
    o.seconds += seconds_since(begin);
    progress.at(std::min(evolution.newest(), c.scene.steps));
    if (is_recorded()) record();
  }
  if (!is_over()) o.status = "interrupted";
  if (evolution.is_direct()) o.iterations_max = 0;
  else if (o.steps_taken > 0) o.iterations_mean = iterations / static_cast<double>(o.steps_taken);
  o.steps = c.scene.steps == 0 ? 0 : evolution.newest();
  o.time = c.scene.steps == 0 ? 0 : evolution.time();
  measure_error(c, c.scene.steps == 0 ? std::span<const double>(start) : evolution.row(), o.time, o);
}

void run_cells(const ComplexScene& c, MeshRecorder& recorder, MeshOutcome& o) {
  AsynchronousEvolution evolution(*c.space, cell_steps(c));
  o.solve = "each cell by its own step, in the order of a priority queue (explicit)";
  o.solve_kind = "explicit";
  o.bytes = evolution.bytes();
  evolution.start(c.values(), c.rates());
  const double h = c.scene.problem.time_step;
  const std::int64_t every = c.scene.every > 0 ? c.scene.every : std::max<std::int64_t>(1, c.scene.steps);
  const auto record = [&] {
    recorder.record(o.steps, o.time, evolution.values(o.time), evolution.energy(o.time), 0, Outcome::unknown,
                    evolution.node_times());
  };
  if (c.scene.every > 0 || c.scene.steps == 0) record();
  Progress progress(c.scene.steps);
  while (o.steps < c.scene.steps && !Interrupt::asked()) {
    const auto begin = Clock::now();
    o.steps = std::min(c.scene.steps, (o.steps / every + 1) * every);
    o.time = static_cast<double>(o.steps) * h;
    evolution.advance(o.time);
    o.seconds += seconds_since(begin);
    o.updates = evolution.updates();
    progress.at(o.steps);
    record();
  }
  if (o.steps < c.scene.steps) o.status = "interrupted";
  measure_error(c, evolution.values(o.time), o.time, o);
}

// A failed figure does not fail the run.
std::string drawn(const ComplexScene& c, const MeshFilm& film, const fs::path& folder) {
  try {
    return draw_mesh(c, film, folder);
  } catch (const std::exception& error) {
    return error.what();
  }
}

}  // namespace

std::vector<double> cell_steps(const ComplexScene& c) {
  std::vector<double> steps;
  for (int cell = 0; cell < c.space->mesh.cells(); ++cell)
    steps.push_back(c.courant * shortest_edge(c.space->mesh, cell));
  return steps;
}

ExitCode run(const ComplexScene& c, const fs::path& folder) {
  const Interrupt interrupt;
  make_results_folder(folder);
  const FolderLock lock(folder);
  remove_earlier_run(folder);
  write_text_file(folder / "scene.ini", resolved_text(c));
  MeshOutcome o;
  o.state = c.state_in_words();
  MeshRecorder recorder(c, folder, c.scene.every > 0 ? c.scene.steps / c.scene.every + 2 : 1, o);
  std::exception_ptr failure;
  try {
    if (c.is_one_problem()) run_static(c, recorder, o);
    else if (c.time == MeshTime::cells) run_cells(c, recorder, o);
    else run_rows(c, recorder, o);
  } catch (const NumericalFailure& error) {
    o.status = status_of(error), o.failure = error.what();
    failure = std::current_exception();
  } catch (const BadInput& bad) {
    throw c.scene.settings.located(bad);
  }
  recorder.close();
  constexpr double most_drift = 0.1;
  if (!c.is_one_problem() && o.energy_error_max > most_drift)
    o.warnings.push_back(fmt::format(
        "the energy is off by {:.3g} of itself: these steps are too long, or the mesh too "
        "coarse; reduce {}",
        o.energy_error_max, c.scene.settings.find("lattice.courant") ? "lattice.courant" : "lattice.time_step"));
  write_text_file(folder / "summary.json", summary_json(c, o));
  const std::string missing = c.scene.figures ? drawn(c, recorder.film(), folder) : std::string();
  fmt::print("{}  {:<10} {}: scene.ini series.csv summary.json{}{}\n", report(c, o), "files", folder.string(),
             c.scene.fields ? has_xdmf(c) ? " fields.h5 fields.xdmf" : " fields.h5" : "",
             c.scene.figures && missing.empty() ? " figures" : "");
  if (!missing.empty()) std::fputs(fmt::format("delf: no figures: {}\n", missing).c_str(), stderr);
  if (failure) std::rethrow_exception(failure);
  return o.status == "interrupted" ? ExitCode::interrupted : ExitCode::done;
}

}  // namespace delf
