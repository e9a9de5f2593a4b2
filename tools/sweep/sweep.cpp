// SPDX-License-Identifier: MIT
#include "tools/sweep/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "lattice/index.hpp"
#include "tools/figures/drawing.hpp"
#include "tools/files/folder_lock.hpp"
#include "tools/files/text_file.hpp"
#include "tools/measure/measure_names.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/seconds_since.hpp"
#include "tools/scene/suggestion.hpp"
#include "tools/sweep/sweep_outcome.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

void take_runs(const std::vector<SweptRun>& runs, RunPool& pool, SweepOutcome& outcome) {
  outcome.asked = runs.size();
  const std::vector<SweepRow> rows = pool.rows_of(runs);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].status.empty()) continue;
    outcome.rows.push_back(rows[i]);
    outcome.values.push_back(runs[i].values);
  }
}

// The runs of a bisection, in the order of the key.
void bisect(const SweepRequest& request, RunPool& pool, SweepOutcome& outcome) {
  const SweptRun first = request.run({fmt::format("{}", request.bisection->low)});
  const auto measures = measure_names(first.scene.settings);
  outcome.number = !request.number.empty() ? request.number : measures.empty() ? "" : measures.front();
  if (outcome.number.empty())
    throw first.scene.settings.error("sweep.bisect",
                                     "of which number? Name it by sweep.number, or give a measure.NAME");
  outcome.threshold = find_threshold(request, outcome.number, pool);
  std::vector<std::size_t> order(outcome.threshold->rows.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return std::stod(outcome.threshold->values[i][0]); });
  for (const std::size_t i : order) {
    outcome.rows.push_back(outcome.threshold->rows[i]);
    outcome.values.push_back(outcome.threshold->values[i]);
  }
  outcome.asked = order.size();
}

void write_tables(const SweepRequest& request, const SweepOutcome& outcome, const fs::path& folder) {
  write_text_file(folder / "sweep.csv", sweep_csv(request, outcome));
  write_text_file(folder / "sweep.json", sweep_json(request, outcome));
}

void draw_and_report(const SweepRequest& request, const SweepOutcome& outcome, const FigureForm& form,
                     const fs::path& folder) {
  remove_figures({"sweep"}, folder);
  const std::string missing = draw_sweep(request, outcome, form, folder);
  fmt::print("{}", sweep_report(request, outcome));
  std::error_code none;
  const bool drawn = fs::exists(folder / "figures" / ("sweep." + form.formats.front()), none);
  fmt::print("{}: sweep.csv sweep.json{}{}\n", folder.string(), request.table ? "" : " runs", drawn ? " figures" : "");
  if (!missing.empty()) fmt::print(stderr, "delf: no figures: {}\n", missing);
}

/// Every row ended well, or the sweep did not: the gravest failure gives the exit code.
void require_rows(const fs::path& scene, const SweepOutcome& outcome) {
  const auto count = [&](const auto& fits) { return std::ranges::count_if(outcome.rows, fits, &SweepRow::status); };
  const auto all = outcome.rows.size(), done = outcome.done();
  if (done == all) return;
  const auto of_system = [](const std::string& status) { return status == "system-failure" || status == "crashed"; };
  const auto of_input = [](const std::string& status) { return status == "bad-input"; };
  if (const auto failed = count(of_system); failed > 0)
    throw SystemFailure(fmt::format(
        "{} of {} runs crashed or were failed by the system: the table above says why; the same command tries them "
        "again",
        failed, all));
  const auto refused = count(of_input);
  if (at(refused) == all)
    throw BadScene(
        fmt::format("{}: none of its runs could begin: the table above has what is wrong with each", scene.string()));
  if (at(refused) + done == all)
    throw BadScene(fmt::format("{}: {} of {} runs could not begin: the table above has what is wrong with each",
                               scene.string(), refused, all));
  throw NumericalFailure(
      done == 0 ? "none of the runs ended well: the table above says why"
                : fmt::format("{} of {} runs did not end well: the table above says why", all - done, all));
}

}  // namespace

ExitCode sweep(const fs::path& scene, const std::vector<Setting>& on_command_line,
               const std::optional<std::string>& out, SweepKind kind) {
  const auto begin = std::chrono::steady_clock::now();
  const Interrupt interrupt;
  const bool compare = kind == SweepKind::compare;
  SweepRequest request = read_sweep_request(scene, on_command_line, compare ? "compare" : "sweep");
  request.compare = compare;
  const fs::path folder = out.value_or("results/" + scene.stem().string() + (compare ? "-compare" : "-sweep"));
  std::vector<SweptRun> runs;  // all are read, and what is wrong with one is found, before files are made
  for (const auto& values : request.values) {
    runs.push_back(request.run(values));
    check_measure_names(runs.back().scene);
  }
  const FigureForm form = runs.empty() ? FigureForm{} : runs.front().scene.figure_form;
  make_results_folder(folder);
  const FolderLock held(folder);  // another sweep there would remove the folders of runs under way

  SweepOutcome outcome;
  outcome.scene = scene.stem().string();
  RunPool pool(request, folder);
  if (request.bisection) bisect(request, pool, outcome);
  else take_runs(runs, pool, outcome);
  if (outcome.number.empty()) outcome.number = request.number.empty() ? usual_number(outcome.rows) : request.number;
  if (Interrupt::asked()) outcome.status = "interrupted";
  outcome.reused = pool.reused();
  outcome.seconds = seconds_since(begin);
  if (pool.number_is_unknown()) outcome.status = "bad-input";
  write_tables(request, outcome, folder);
  // It takes a row to know: the numbers of a run are those of its summary.json.
  if (pool.number_is_unknown())
    throw BadScene(fmt::format("command line: --sweep.number = {}: is no number of summary.json and no measure{}",
                               request.number, suggestion(request.number, pool.known_numbers())));
  draw_and_report(request, outcome, form, folder);
  if (outcome.status == "interrupted") return ExitCode::interrupted;
  require_rows(scene, outcome);
  return ExitCode::done;
}

}  // namespace delf
