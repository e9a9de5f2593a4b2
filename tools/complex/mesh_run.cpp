// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>

#include "tools/complex/mesh_stepping.hpp"
#include "tools/complex/mesh_summary.hpp"
#include "tools/complex/static_field.hpp"
#include "tools/report/seconds_since.hpp"
#include "tools/run/run_folder.hpp"
#include "tools/warnings/energy_warnings.hpp"

namespace delf {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Steps too long for the stencils make waves that grow from level to level, and every equation holds.
void warn_of_growth(const ComplexScene& c, const StaticField& field, Outcome& o) {
  const auto d = c.fields.size();
  double given = 0, found = 0;
  for (std::size_t n = 0; n < field.values().size(); ++n) {
    double& largest = field.system().complex().is_unknown(static_cast<int>(n / d)) ? found : given;
    largest = std::max(largest, std::abs(field.values()[n]));
  }
  if (const Found grown = field_beyond_data(found, given,
                                            "the steps in time are too long for the stencils, or the data are not "
                                            "those of a solution; use shorter steps"))
    o.warnings.push_back(*grown);
}

/// Returns the level of each site.
std::vector<int> run_static(const ComplexScene& c, MeshRecorder& recorder, Outcome& o) {
  StaticField field(c);
  o.solve = field.solver().plan().describe();
  o.solve_kind = field.solver().plan().largest == 1 ? "explicit" : "sparse";
  o.threads = threads_in_words(field.solver(), c.scene.problem.threads);
  o.bytes = field.bytes();
  const auto begin = Clock::now();
  ComplexSolver::Report solved;
  double residual = 0;
  try {
    solved = field.solve();
    residual = field.residual();
    if (!solved.ended && !is_solution(residual, c.scene.problem.tolerance))
      throw NoConvergence(
          fmt::format("Newton's method ended where the residual of the equations is {:.2g} of their terms; "
                      "begin with a field nearer to the solution",
                      residual));
  } catch (const NumericalFailure& error) {
    o.status = status_of(error), o.failure = error.what();
    throw;
  }
  o.seconds = seconds_since(begin);
  o.iterations_mean = o.iterations_max = solved.iterations;
  if (solved.ended) o.status = "interrupted";
  if (c.stencils && !solved.ended) warn_of_growth(c, field, o);
  o.warnings.insert(o.warnings.end(), c.tiling.gaps.begin(), c.tiling.gaps.end());
  if (solved.undetermined > 0)
    o.warnings.push_back(
        fmt::format("the equations hold to rounding, and hardly change in one direction: along it the values are known "
                    "to {:.2g} of themselves only",
                    solved.undetermined));
  std::vector<SlabEnergy> slabs;
  if (c.stencils) slabs = slab_energies(*c.stencils, c.theory->shared_density(), field.values());
  recorder.record(
      {.values = field.values(),
       .energy = c.stencils ? Outcome::unknown : field.energy(),
       .iterations = solved.iterations,
       .residual = residual,
       .constraint = c.theory->constraint() ? c.space->largest_constraint(field.values()) : Outcome::unknown,
       .multipliers = field.multipliers()},
      slabs);
  measure_error(c, field.values(), 0, o);
  return c.stencils ? field.solver().plan().level_of_sites(c.sites()) : std::vector<int>();
}

}  // namespace

ExitCode run(const ComplexScene& c, const fs::path& folder, Resumed resumed) {
  Outcome o;
  o.state = c.state_in_words();
  o.start = StartRule::legendre;
  std::optional<MeshStepping> stepping;
  std::optional<RunFiles::Written> kept;
  try {
    if (!c.is_one_problem()) kept = stepping.emplace(c, o).begin(resumed.state.get());
  } catch (const BadInput& bad) {
    throw c.scene.settings.located(bad);
  }
  RunFolder run(folder, resumed, o);
  MeshRecorder recorder(c, folder, o, kept);
  Checkpoints checkpoints = run.begin(recorder, c.scene, resolved_text(c));
  std::vector<int> levels;
  run.attempt([&] {
    try {
      if (stepping) stepping->run(recorder, checkpoints);
      else levels = run_static(c, recorder, o);
    } catch (const BadInput& bad) {
      throw c.scene.settings.located(bad);
    }
  });
  if (run.failures().first() && o.status == "done")
    std::rethrow_exception(run.failures().first());  // bad input: there are no results
  if (stepping) stepping->describe(o);
  run.attempt([&] { recorder.close(); });
  return run.end(subject_of(c), c.scene,
                 [&] { return c.scene.figures ? draw_mesh(c, recorder.frames(), levels, folder) : std::string(); });
}

}  // namespace delf
