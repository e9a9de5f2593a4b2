// SPDX-License-Identifier: MIT
#include "tools/run/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lattice/index.hpp"
#include "schemes/driven_ends.hpp"
#include "schemes/methods/energies.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/stability/constraint_ghost.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/theories/angles.hpp"
#include "tools/compare/estimate_error.hpp"
#include "tools/figures/figures.hpp"
#include "tools/files/lattice_xdmf.hpp"
#include "tools/files/state_in_memory.hpp"
#include "tools/files/text_file.hpp"
#include "tools/outcome/outcome.hpp"
#include "tools/report/modified.hpp"
#include "tools/report/text_columns.hpp"
#include "tools/rows/engine.hpp"
#include "tools/rows/initial_rows.hpp"
#include "tools/run/drawn_spectrum.hpp"
#include "tools/run/failures_of_run.hpp"
#include "tools/run/recorder.hpp"
#include "tools/run/run_folder.hpp"
#include "tools/run/run_in_memory.hpp"
#include "tools/run/stepping.hpp"
#include "tools/run/tiny_steps.hpp"
#include "tools/scene/values.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

// Rows that a run starts from are not to be written over.
void refuse_own_rows(const fs::path& folder, const Scene& scene) {
  std::error_code error;
  for (const char* name : {"fields.h5", "series.csv"})
    if (scene.from_file() && fs::equivalent(scene.initial_file, folder / name, error))
      throw scene.settings.error("initial.file", "is the file that this run would write to; choose another --out");
}

std::string energy_in_words(const Problem& problem) {
  return fmt::format(fmt::runtime(energy_of_run(problem).formula), problem.method);
}

// Figures of the rows that the recorder kept.
std::string drawn(const Scene& scene, const InitialRows& initial, const FieldTheory& fields, const RowNames& names,
                  const Recorder& recorder, const Outcome& outcome, DrawnSection section, const DrawnSpectrum* spectrum,
                  const fs::path& folder) {
  if (!recorder.thinned_rows()) return {};
  const auto density = scene.problem.parameters.maybe<std::string>("theory.density");
  const std::string theory = density && !density->empty() ? "ℓ = " + shortened(*density, 70) : scene.problem.theory;
  const std::vector<int> angles = angles_of(scene.problem.theory, fields, scene.problem.parameters);
  const bool angle = scene.problem.circle_valued || angles.size() == at(fields.components());
  return draw_figures({scene.name, theory, scheme_in_words(scene.problem), angle, scene.problem.lattice,
                       initial.winding(), *recorder.thinned_rows(), recorder.energy_errors(), scene.times, names,
                       energy_in_words(scene.problem), std::move(section), scene.figure_form, initial.exact(),
                       outcome.maxima_over, gain_of(scene.problem.parameters), recorder.momenta(), spectrum},
                      folder);
}

// The limit of the step, where the first rows tell.
std::string limit_of(const Scene& scene, const Simulation& simulation) {
  const auto limit = find_method(scene.problem.method).limit;
  const Stepper& stepper = simulation.evolution().stepper();
  if (!limit || simulation.newest() < 1) return {};
  return limit({simulation.theory(), simulation.evolution().system(), stepper.window(2), stepper.newest(),
                scene.problem.time_step});
}

// A run would end in growing rounding errors.
void refuse_ghost(const Scene& scene, const LatticeSystem& system) {
  if (const auto ghost = ghost_under_constraint(system))
    throw scene.settings.error(
        "lattice.stencil", fmt::format("{}; {}", in_words_under_constraint(*ghost), without_ghost_under_constraint));
}

// A run up to its first rows.
struct Begun {
  Outcome outcome;
  const InitialRows initial;
  Simulation simulation;
  bool estimated = false;
  RowNames names;
  std::optional<ModifiedEnergy> modified;
  std::optional<OwnEnergy> own;
  std::optional<Stepping> stepping;  ///< always there

  explicit Begun(const Scene& scene) : initial(scene), simulation(build(scene, initial.winding())) {
    outcome.winding = initial.winding();
    require_determined(scene, simulation);
    refuse_ghost(scene, simulation.evolution().system());
    estimated = Values(scene.settings).toggle("output.estimate");
    if (estimated) require_estimable(scene, simulation.evolution().system());
    outcome.state = initial.description();
    outcome.start = initial.rule();
    outcome.solve = simulation.solve_summary();
    outcome.solve_kind = simulation.solve_kind();
    names = RowNames(simulation);
    Problem problem = scene.problem;
    problem.winding = outcome.winding;
    outcome.energy_of = energy_of_run(problem).name;
    const bool driven = !key_of_driven_end(problem).empty();
    const auto order = Values(scene.settings).integer("output.modified");
    if (order != 0 && scene.problem.lattice.space() != Space::interval) {
      if (order % 2 != 0) throw scene.settings.error("output.modified", "is an even order, 2, 4 or 6; 0 for none");
      try {
        modified.emplace(modified_energy(problem, simulation, static_cast<int>(order), initial.monodromy()));
      } catch (const BadInput& bad) {
        throw scene.settings.located(bad);
      }
      for (const std::string& name : names_of_modified(scene)) names.further.push_back(name);
    }
    if (!driven) own = own_energy(simulation, problem);
    if (own) names.further.emplace_back("energy_own");
    if (driven) names.further.emplace_back(energy_less_work);
    stepping.emplace(scene, initial, simulation, names, modified, own, outcome);
  }
  Begun(const Begun&) = delete;
  Begun& operator=(const Begun&) = delete;

  std::optional<RunFiles::Written> begin(const Scene& scene, SavedState* checkpoint) {
    const auto kept = stepping->begin(checkpoint);
    if (kept) return kept;
    if (simulation.newest() > 0) refuse_tiny_steps(scene, simulation.time(1) - simulation.time(0), "<phi_x^2>");
    outcome.limit = limit_of(scene, simulation);
    return kept;
  }
  /// Steps, with each part tried after the first failure.
  template <class Attempts>
  void step(const Scene& scene, Recorder& recorder, Checkpoints& checkpoints, Attempts& attempts) {
    attempts.attempt([&] { stepping->run(recorder, checkpoints); });
    if (estimated)
      attempts.attempt([&] {
        outcome.error_estimate = estimate_error(scene, outcome, stepping->last_row());
        if (outcome.error_estimate->interrupted) outcome.status = "interrupted";  // what was asked for is not all there
      });
    outcome.bytes = simulation.bytes();  // only now is everything there that rows are checked with
    attempts.attempt([&] { recorder.close(); });
  }
};

ExitCode run_in(const fs::path& folder, const Scene& scene, const Resumed& resumed) {
  Begun begun(scene);
  Outcome& outcome = begun.outcome;
  Stepping& stepping = *begun.stepping;
  const auto kept = begun.begin(scene, resumed.state.get());
  if (!kept) refuse_own_rows(folder, scene);
  RunFolder run(folder, resumed, outcome);
  const std::string resolved = resolved_text(scene, outcome.start, outcome.state);
  Recorder recorder(scene, folder, resolved, outcome.winding, begun.names, kept);
  Checkpoints checkpoints = run.begin(recorder, scene, resolved);
  begun.step(scene, recorder, checkpoints, run);
  if (scene.fields && outcome.records > 0 && scene.problem.lattice.space() != Space::point &&
      Values(scene.settings).toggle("output.xdmf"))
    run.attempt([&] { write_lattice_xdmf(folder, begun.names); });
  DrawnSection section;
  if (const Section* points = stepping.section()) {
    section = {points->table(), points->title(), points->drawn_columns()};
    run.attempt([&] { write_text_file(folder / "section.csv", section.table); });
  }
  return run.end(subject_of(scene.problem), scene, [&] {
    DrawnSpectrum spectrum;
    const bool asked = Values(scene.settings).toggle("figures.spectrum");
    if (asked && scene.problem.lattice.is_circle()) {
      spectrum = waves_of(scene, begun.simulation);
      spectrum.first_row = begun.initial.row0(), spectrum.last_row = stepping.last_row();
      spectrum.last_time = outcome.time;
    }
    return drawn(scene, begun.initial, begun.simulation.theory(), begun.names, recorder, outcome, std::move(section),
                 asked ? &spectrum : nullptr, folder);
  });
}

}  // namespace

ExitCode run(const Scene& scene, const fs::path& folder, Resumed resumed) {
  return with_memory_for(scene, [&] { return run_in(folder, scene, resumed); });
}

RunInMemory run_in_memory(const Scene& given, const std::string& state, const SeenInMemory& seen) {
  Scene scene = given;
  std::optional<StateReader> earlier;
  CheckpointHead head;
  if (!state.empty()) {
    head.visit(earlier.emplace(state));
    if (scene.until)
      scene.steps = std::max(scene.steps, head.row + 1);  // their number is a guess where the field chooses
    if (head.row >= scene.steps)
      throw BadInput("run.steps", fmt::format("resume: the run is at row {}, and run.steps = {}; raise run.until or "
                                              "run.steps, as steps={}",
                                              head.row, scene.steps, 2 * std::max<std::int64_t>(1, head.row)));
  }
  RunInMemory result;
  with_memory_for(scene, [&] {
    Begun begun(scene);
    const auto kept = begun.begin(scene, earlier ? &*earlier : nullptr).value_or(RunFiles::Written());
    seen.begin(begun.names, kept.series.size);
    FailuresOfRun failures(begun.outcome);
    Recorder recorder(begun.names, seen.record, kept);
    if (earlier) recorder.visit(*earlier);
    Checkpoints checkpoints(result.state);
    begun.step(scene, recorder, checkpoints, failures);
    const Subject subject = subject_of(scene.problem);
    result = {begun.outcome.status,
              summary_json(subject, scene, begun.outcome),
              report(subject, scene, begun.outcome),
              resolved_text(scene, begun.outcome.start, begun.outcome.state),
              begun.stepping->section() ? begun.stepping->section()->table() : "",
              std::move(result.state),
              failures.first()};
    return ExitCode::done;
  });
  return result;
}

}  // namespace delf
