// SPDX-License-Identifier: MIT
#include "tools/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "tools/outcome/outcome.hpp"
#include "tools/report/equations.hpp"
#include "tools/report/in_words.hpp"
#include "tools/report/modified.hpp"
#include "tools/report/seconds_since.hpp"
#include "tools/rows/engine.hpp"
#include "tools/rows/initial_rows.hpp"
#include "tools/run/stepping.hpp"
#include "tools/warnings/waves_in_words.hpp"

namespace delf {

namespace {

std::string recording(const Scene& scene) {
  if (scene.every == 0) return "the last row only";
  return fmt::format("every {} of {} rows: {} records", scene.every, scene.steps + 1,
                     (scene.steps + scene.every - 1) / scene.every + 1);
}

std::string output(const Scene& scene, std::size_t components) {
  const double records = scene.every == 0 ? 1 : static_cast<double>((scene.steps + scene.every - 1) / scene.every + 1);
  std::string kept = "scene.ini, series.csv, summary.json", left_out;
  if (scene.fields)
    kept += fmt::format(
        ", fields.h5 ({})",
        bytes_in_words(8 * records * (static_cast<double>(components) * scene.problem.lattice.sites() + 1)));
  else left_out += "  left out   fields.h5: HDF5 is not touched\n";
  if (scene.figures) kept += ", figures";
  else left_out += "  left out   figures: no rows are kept for them, and gnuplot is not started\n";
  return fmt::format("  written    {}\n{}", kept, left_out);
}

struct Trial {
  std::int64_t steps = 0;
  double seconds = 0;
};

// Steps until so many are taken or so much time has passed, whichever is first. The clock is read between
// batches: reading it costs as much as a small step.
Trial step_for(double limit, std::int64_t most, Simulation& simulation) {
  using Clock = std::chrono::steady_clock;
  Trial trial;
  std::int64_t batch = 1;
  while (trial.steps < most && trial.seconds < limit) {
    const std::int64_t last = std::min(trial.steps + batch, most);
    const auto begin = Clock::now();
    simulation.steps(static_cast<int>(last - trial.steps));
    trial.steps = last;
    trial.seconds += seconds_since(begin);
    const double fitting = (limit - trial.seconds) / trial.seconds * static_cast<double>(trial.steps);
    batch = std::max<std::int64_t>(1, fitting < 2. * static_cast<double>(batch) ? std::llround(fitting) : 2 * batch);
  }
  return trial;
}

// The cost of the steps of a run, from the first of them.
std::string cost(const Scene& scene, const InitialRows& initial, Simulation& simulation) {
  constexpr std::int64_t warming_steps = 16;  // predictors have reached their order, caches and pages are warm
  constexpr double limit = 0.05;
  try {
    initial.start(simulation);
    const std::int64_t steps = scene.steps - simulation.newest();
    if (steps <= 0) return "none: no step is taken";
    const Trial first = step_for(limit / 2, std::min(steps, warming_steps), simulation);
    const Trial then = step_for(limit - first.seconds, steps - first.steps, simulation);
    const Trial& counted = then.steps < first.steps ? first : then;
    const std::int64_t trials = first.steps + then.steps;
    const double of_a_step = counted.seconds / static_cast<double>(counted.steps);
    return fmt::format("{} on this machine ({} trial step{}); {} steps: {}, without output",
                       cost_in_words(1e9 * of_a_step / scene.problem.lattice.sites()), trials, trials == 1 ? "" : "s",
                       scene.steps, duration_in_words(of_a_step * static_cast<double>(steps)));
  } catch (const NumericalFailure& failure) {
    return fmt::format("not predicted: {}", failure.what());
  }
}

/// Lines below the first are indented as far as it is.
std::string broken_lines(std::string text) {
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos;) text.insert(++at, 13, ' ');
  return text;
}

}  // namespace

ExitCode plan(const Scene& scene, bool latex) {
  return with_memory_for(scene, [&] {
    const InitialRows initial(scene);
    Simulation simulation = build(scene, initial.winding());
    initial.check(simulation);
    require_determined(scene, simulation);
    if (latex) {
      try {
        fmt::print("{}", equations_in_latex(scene.problem, simulation));
      } catch (const BadInput& bad) {
        throw scene.settings.located(bad);
      }
      return ExitCode::done;
    }
    fmt::print("{}: {}, {}, {} steps to t = {:.6g}\n", scene.name, scene.problem.theory, scheme_in_words(scene.problem),
               scene.steps, scene.end());
    if (scene.problem.step_control)
      fmt::print("  steps      h = {:.6g}/sqrt(1 + {:.6g}^2 <phi_x^2>), reversible; about so many, or more\n",
                 scene.problem.time_step, *scene.problem.step_control);
    fmt::print(
        "  (A slab is what is solved together, row j and its inner nodes; stencils are sites (row, site) from the "
        "first one.\n"
        "   Below: what each value is solved from, by which matrix, the memory of the whole run, and the time of trial "
        "steps.)\n");
    fmt::print("  state      {}; row 1 is {}\n", initial.description(),
               initial.rule() == StartRule::exact     ? "known"
               : initial.rule() == StartRule::centred ? "solved for, with y(-1) = y(1) - 2 h phi_t"
               : initial.rule() == StartRule::values  ? "the first step, from the values of row 0 alone"
                                                      : "solved for, by the discrete Legendre transform");
    fmt::print("{}", equations_in_words(scene.problem, simulation));
    fmt::print("  recorded   {}\n{}\n{}", recording(scene), output(scene, simulation.components().size()),
               simulation.plan_report());
    if (const std::string threads = threads_in_words(simulation, scene.problem.threads); !threads.empty())
      fmt::print("threads      {}\n", threads);
    if (const std::string waves = waves_in_words(scene, simulation); !waves.empty())
      fmt::print("waves        {}\n", broken_lines(waves));
    fmt::print("cost         {}\n", cost(scene, initial, simulation));
    return ExitCode::done;
  });
}

ExitCode plan_modified(const Scene& scene, int order, bool latex) {
  return with_memory_for(scene, [&] {
    const InitialRows initial(scene);
    const Simulation simulation = build(scene, initial.winding());
    try {
      ModifiedLagrangian modified = modified_lagrangian(scene.problem, simulation, order);
      const std::shared_ptr<const SymbolicDensity> density = text_of(scene.problem, simulation.theory());
      if (latex) {
        fmt::print("{}", modified_in_latex(modified, *density));
        return ExitCode::done;
      }
      fmt::print("{}: {}, {}{}\n{}", scene.name, scene.problem.theory, scheme_in_words(scene.problem),
                 simulation.is_processed() ? ", the rows of its kernel" : "", modified_in_words(modified, *density));
    } catch (const BadInput& bad) {
      throw scene.settings.located(bad);
    }
    return ExitCode::done;
  });
}

}  // namespace delf
