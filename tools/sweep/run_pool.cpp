// SPDX-License-Identifier: MIT
#include "tools/sweep/run_pool.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>

#include "tools/complex/mesh_run.hpp"
#include "tools/files/text_file.hpp"
#include "tools/report/failure.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/progress.hpp"
#include "tools/run/run.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

/// The run, in a process of its own.
ExitCode carry_out(const SweptRun& run, const fs::path& folder) {
  try {
    AnyScene own = read_any_scene(run.scene.settings);
    std::visit([&](auto& scene) { common_part(scene).warnings = run.scene.warnings; }, own);
    return std::visit([&](const auto& scene) { return delf::run(scene, folder); }, own);
  } catch (const std::exception& error) {
    std::fflush(stdout);
    fmt::print(stderr, "{}\n", error_line(error));
    return exit_code(error);
  }
}

}  // namespace

RunPool::RunPool(const SweepRequest& request, const fs::path& folder)
    : request_(request), folder_(folder), journal_(folder / "sweep.rows", request.resume) {}

// runs/KEY=VALUE,KEY=VALUE: the same for the same settings; of rows only, a folder for as long as the run lasts.
fs::path RunPool::folder_of(const SweptRun& run, std::size_t number) const {
  if (request_.table) return fs::path("runs") / fmt::format("{}", number);
  std::string name;
  for (std::size_t i = 0; i < request_.keys.size(); ++i)
    name += (i == 0 ? "" : ",") + request_.keys[i] + "=" + run.values[i];
  constexpr std::size_t longest = 150;
  const auto plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("._+-=,", c); };
  if (name.size() > longest || !std::ranges::all_of(name, plain)) {
    for (char& c : name)
      if (!plain(c)) c = '_';
    name = name.substr(0, longest) + "-" + fingerprint_of(run.scene);
  }
  return fs::path("runs") / name;
}

const SweepRow* RunPool::known(const std::string& fingerprint) const {
  const SweepRow* row = journal_.find(fingerprint);
  if (!row || request_.table) return row;
  std::error_code none;  // a folder that somebody has removed is made again
  return !row->folder.empty() && fs::exists(folder_ / row->folder, none) ? row : nullptr;
}

RunPool::Process RunPool::start(const SweptRun& run, std::size_t number) {
  const fs::path folder = folder_of(run, number);
  std::error_code none;
  fs::remove_all(folder_ / folder, none);
  make_results_folder(folder_ / folder);
  const LoggedProcess process =
      start_logged(folder_ / folder, "run", "sweep.jobs", [&] { return carry_out(run, folder_ / folder); });
  return {process, number, folder};
}

SweepRow RunPool::finished(const Process& process, const SweptRun&, const std::string& fingerprint) {
  const int status = status_of(process.process);
  SweepRow row{fingerprint, "crashed", "", request_.table ? "" : process.folder.string(), {}};
  std::ifstream in(folder_ / process.folder / "summary.json");
  row.summary = nlohmann::ordered_json::parse(in, nullptr, false);
  if (!row.summary.is_object()) row.summary = nullptr;
  if (WIFSIGNALED(status)) {
    row.failure = fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  } else if (row.summary.is_object()) {
    row.status = row.summary.value("status", "");
    if (row.summary["failure"].is_string()) row.failure = row.summary["failure"];
  } else {
    const auto code = static_cast<ExitCode>(WEXITSTATUS(status));
    row.status = code == ExitCode::bad_input         ? "bad-input"
                 : code == ExitCode::numerics_failed ? "failed"
                                                     : "system-failure";
    row.failure = error_in_log(folder_ / process.folder);
  }
  if (request_.table) fs::remove_all(folder_ / process.folder);
  // A run may go well another time if the machine ended it.
  if (row.status != "crashed" && row.status != "system-failure" && row.status != "interrupted") journal_.append(row);
  return row;
}

void RunPool::look_for_number(const SweepRow& row) {
  if (request_.number.empty() || !known_numbers_.empty()) return;
  known_numbers_ = row.numbers();
}

bool RunPool::number_is_unknown() const {
  return !known_numbers_.empty() && std::ranges::find(known_numbers_, request_.number) == known_numbers_.end();
}

std::vector<SweepRow> RunPool::rows_of(const std::vector<SweptRun>& runs) {
  std::vector<SweepRow> rows(runs.size());
  std::vector<std::string> fingerprints;
  std::vector<std::size_t> waiting;           // the next one last
  std::map<std::string, std::size_t> places;  // of the first run of each fingerprint: the same run is not run twice
  for (std::size_t i = 0; i < runs.size(); ++i) {
    fingerprints.push_back(fingerprint_of(runs[i].scene));
    if (const SweepRow* row = known(fingerprints[i])) rows[i] = *row, ++reused_, look_for_number(rows[i]);
    else if (places.emplace(fingerprints[i], i).second) waiting.insert(waiting.begin(), i);
  }
  const auto all = static_cast<std::int64_t>(waiting.size());
  Progress progress(all, "run");
  std::vector<Process> running;
  try {
    while ((!waiting.empty() || !running.empty()) && !Interrupt::asked() && !number_is_unknown()) {
      while (!waiting.empty() && static_cast<int>(running.size()) < request_.jobs) {
        running.push_back(start(runs[waiting.back()], waiting.back()));
        waiting.pop_back();
      }
      std::vector<LoggedProcess> processes;
      for (const Process& process : running) processes.push_back(process.process);
      for (const std::size_t i : ended_of(processes)) {
        const Process process = running[i];
        running.erase(running.begin() + static_cast<std::ptrdiff_t>(i));
        rows[process.run] = finished(process, runs[process.run], fingerprints[process.run]);
        look_for_number(rows[process.run]);
        progress.at(all - static_cast<std::int64_t>(waiting.size() + running.size()));
      }
    }
  } catch (...) {
    for (const Process& process : running) give_up(process.process);
    throw;
  }
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (const auto first = places.find(fingerprints[i]); first != places.end() && first->second != i)
      rows[i] = rows[first->second];
  for (const Process& process : running) {
    give_up(process.process);
    std::error_code none;
    fs::remove_all(folder_ / process.folder, none);
  }
  if (std::error_code none; request_.table) fs::remove(folder_ / "runs", none);  // if it is empty
  return rows;
}

}  // namespace delf
