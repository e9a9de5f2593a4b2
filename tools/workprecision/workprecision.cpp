// SPDX-License-Identifier: MIT
#include "tools/workprecision/workprecision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "tools/figures/drawing.hpp"
#include "tools/files/text_file.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/progress.hpp"
#include "tools/report/seconds_since.hpp"
#include "tools/rows/engine.hpp"
#include "tools/workprecision/lower_envelope.hpp"
#include "tools/workprecision/reference_run.hpp"
#include "tools/workprecision/timed_rounds.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

// Shares of the budget: of the reference, and at most; of all first runs.
constexpr double reference_share = 0.1, longest_reference = 0.4, search_share = 0.6;

Clock::time_point after(Clock::time_point begin, double seconds) {
  return begin + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

ExitCode workprecision_in(const fs::path& folder, const Scene& scene) {
  const Interrupt interrupt;
  const WorkPrecisionRequest request = read_workprecision_request(scene);
  const WorkPrecisionOutcome outcome = compare_schemes(scene, request);
  make_results_folder(folder);
  write_text_file(folder / "workprecision.json", workprecision_json(scene, request, outcome));
  write_text_file(folder / "workprecision.csv", workprecision_csv(outcome));
  write_text_file(folder / "workprecision.md", workprecision_markdown(scene, request, outcome));
  write_text_file(folder / "workprecision.tex", workprecision_latex(scene, request, outcome));
  std::error_code none;
  remove_figures({"workprecision"}, folder);
  const std::string missing =
      scene.figures && !outcome.runs.empty() ? draw_workprecision(scene, outcome, folder) : std::string();
  fmt::print("{}", workprecision_report(scene, request, outcome));
  const bool drawn = fs::exists(folder / "figures" / ("workprecision." + scene.figure_form.formats.front()), none);
  fmt::print("{}: workprecision.json workprecision.csv workprecision.md workprecision.tex{}\n", folder.string(),
             drawn ? " figures" : "");
  if (!missing.empty()) fmt::print(stderr, "delf: no figures: {}\n", missing);
  if (outcome.status == "interrupted") return ExitCode::interrupted;
  if (outcome.runs.empty())
    throw NumericalFailure(
        "no run could be timed, for the reasons above; lower lattice.courant, or choose others of "
        "workprecision.schemes");
  return ExitCode::done;
}

}  // namespace

WorkPrecisionOutcome compare_schemes(const Scene& scene, const WorkPrecisionRequest& request) {
  const auto begin = Clock::now();
  WorkPrecisionOutcome outcome;
  const std::vector<WorkPrecisionEntry> schemes = entries(scene, request);
  const auto reference = find_reference(scene, request, after(begin, reference_share * request.budget),
                                        RunLimit(after(begin, longest_reference * request.budget)));
  if (!reference) {
    outcome.status = "interrupted";
    outcome.reference = "a finer run, which was interrupted";
    for (const WorkPrecisionEntry& one : schemes)
      outcome.left_out.push_back({one.name, "interrupted before it was run"});
    outcome.seconds = seconds_since(begin);
    return outcome;
  }
  outcome.reference = reference->words;
  outcome.reference_error = reference->error;

  constexpr double milli = 1e-3;
  Progress progress(static_cast<std::int64_t>(request.budget / milli), "millisecond");
  const auto tell = [&] {
    progress.at(std::min(static_cast<std::int64_t>(seconds_since(begin) / milli),
                         static_cast<std::int64_t>(request.budget / milli)));
  };
  ResolutionSearch search(scene, request, schemes, reference->solution);
  search.run(after(Clock::now(), search_share * (request.budget - seconds_since(begin))), tell);
  outcome.left_out = search.left_out();
  outcome.tried = search.tried();

  std::vector<TriedRun> runs = search.worth_timing();
  std::vector<double> costs;
  for (const TriedRun& run : runs) costs.push_back(run.result.seconds + run.result.seconds_setup);
  const std::vector<int> repeats = shared_repeats(costs, request.repeats, request.budget - seconds_since(begin));
  time_in_turn(runs, schemes, repeats, request.seed, StepClock(scene.problem.threads), after(begin, request.budget),
               tell);

  outcome.fewer_repeats =
      std::ranges::any_of(runs, [&](const TriedRun& run) { return run.result.repeats < request.repeats; });
  for (TriedRun& run : runs) outcome.runs.push_back(std::move(run.result));
  std::ranges::stable_sort(outcome.runs, [](const WorkPrecisionRun& a, const WorkPrecisionRun& b) {
    if (a.peer != b.peer) return b.peer;
    return a.scheme != b.scheme ? a.scheme < b.scheme : a.seconds < b.seconds;
  });
  compare(outcome, request.accuracies);
  if (Interrupt::asked()) outcome.status = "interrupted";
  outcome.seconds = seconds_since(begin);
  return outcome;
}

ExitCode workprecision(const Scene& scene, const fs::path& folder) {
  return with_memory_for(scene, [&] { return workprecision_in(folder, scene); });
}

}  // namespace delf
