// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lattice/index.hpp"
#include "tools/files/csv_cell.hpp"
#include "tools/outcome/findings_json.hpp"
#include "tools/report/in_words.hpp"
#include "tools/sweep/sweep_outcome.hpp"

namespace delf {

namespace {

// The numbers of all rows, in the order in which they first come.
std::vector<std::string> all_numbers(const std::vector<SweepRow>& rows) {
  std::vector<std::string> all;
  for (const SweepRow& row : rows)
    for (const std::string& name : row.numbers())
      if (std::ranges::find(all, name) == all.end()) all.push_back(name);
  return all;
}

// The number of the sweep; side by side also what runs of one scene are compared by, where any of them has it.
std::vector<std::string> shown_numbers(const SweepRequest& request, const SweepOutcome& outcome) {
  std::vector<std::string> numbers{outcome.number};
  if (!is_side_by_side(request, outcome)) return numbers;
  for (const char* name : {"error_linf", "error_l2", "energy_error_max", "residual_max", "ns_per_site_step"})
    if (name != outcome.number &&
        std::ranges::any_of(outcome.rows, [&](const SweepRow& row) { return std::isfinite(row.number(name)); }))
      numbers.emplace_back(name);
  return numbers;
}

// A run that ended well may be wrong all the same, and says so in its summary.json.
std::string warnings_in_words(const std::vector<SweepRow>& rows) {
  std::size_t runs = 0;
  std::string first;
  for (const SweepRow& row : rows) {
    if (!row.summary.is_object()) continue;
    const auto warnings = row.summary.find("warnings");
    if (warnings == row.summary.end() || warnings->empty()) continue;
    if (runs++ == 0) first = warnings->front();
  }
  return runs == 0 ? "" : fmt::format("  warnings   of {} runs, in sweep.json; the first: {}\n", runs, first);
}

}  // namespace

std::size_t SweepOutcome::done() const { return at(std::ranges::count(rows, "done", &SweepRow::status)); }

std::string usual_number(const std::vector<SweepRow>& rows) {
  const auto there = [&](const std::string& name) {
    return std::ranges::any_of(rows, [&](const SweepRow& row) { return std::isfinite(row.number(name)); });
  };
  for (const SweepRow& row : rows)
    if (const auto measures = row.summary.is_object() ? row.summary.find("measures") : row.summary.end();
        row.summary.is_object() && measures != row.summary.end() && !measures->empty())
      return measures->begin().key();
  for (const char* name : {"error_linf", "energy_error_max", "energy_final"})
    if (there(name)) return name;
  return {};
}

std::string sweep_csv(const SweepRequest& request, const SweepOutcome& outcome) {
  const std::vector<std::string> numbers = all_numbers(outcome.rows);
  std::string text;
  for (const std::string& key : request.keys) text += csv_cell(key) + ",";
  text += "status";
  for (const std::string& name : numbers) text += "," + csv_cell(name);
  text += ",failure\n";
  for (std::size_t i = 0; i < outcome.rows.size(); ++i) {
    for (const std::string& value : outcome.values[i]) text += csv_cell(value) + ",";
    text += outcome.rows[i].status;
    for (const std::string& name : numbers) text += fmt::format(",{}", outcome.rows[i].number(name));
    text += "," + csv_cell(outcome.rows[i].failure) + "\n";
  }
  return text;
}

std::string sweep_json(const SweepRequest& request, const SweepOutcome& outcome) {
  Json json = json_head(outcome.scene);
  json["status"] = outcome.status;
  json["command"] = request.compare ? "compare" : "sweep";
  json["keys"] = request.keys;
  json["number"] = text_or_null(outcome.number);
  json["jobs"] = request.jobs;
  json["seconds"] = outcome.seconds;
  json["runs_asked"] = outcome.asked;
  json["runs_done"] = outcome.done();
  json["runs_reused"] = outcome.reused;
  if (const auto& t = outcome.threshold; t && t->found)
    json["threshold"] = {{"key", request.keys[0]},
                         {"value", 0.5 * (t->low + t->high)},
                         {"low", t->low},
                         {"high", t->high},
                         {"number", outcome.number},
                         {"level", t->level},
                         {"at_low", t->at_low},
                         {"at_high", t->at_high}};
  auto& runs = json["runs"] = Json::array();
  for (std::size_t i = 0; i < outcome.rows.size(); ++i) {
    const SweepRow& row = outcome.rows[i];
    Json settings = Json::object();
    for (std::size_t a = 0; a < request.keys.size(); ++a) settings[request.keys[a]] = outcome.values[i][a];
    runs.push_back({{"settings", settings},
                    {"status", row.status},
                    {"failure", text_or_null(row.failure)},
                    {"folder", text_or_null(row.folder)},
                    {"summary", row.summary}});
  }
  return json_text(json);
}

std::string sweep_report(const SweepRequest& request, const SweepOutcome& outcome) {
  constexpr std::size_t most_lines = 40;
  std::string text = fmt::format("{}: {} of {} runs, {} of them ended well{}; {} at {} side by side\n", outcome.scene,
                                 outcome.rows.size(), outcome.asked, outcome.done(),
                                 outcome.reused > 0 ? fmt::format(", {} known from before", outcome.reused) : "",
                                 duration_in_words(outcome.seconds), request.jobs);
  if (outcome.rows.size() <= most_lines) {
    const std::vector<std::string> numbers = shown_numbers(request, outcome);
    text += "  ";
    for (const std::string& key : request.keys) text += fmt::format("{:<22} ", key);
    for (const std::string& number : numbers) text += fmt::format("{:<16} ", number);
    text += "status\n";
    for (std::size_t i = 0; i < outcome.rows.size(); ++i) {
      text += "  ";
      for (const std::string& value : outcome.values[i]) text += fmt::format("{:<22} ", value);
      const SweepRow& row = outcome.rows[i];
      for (const std::string& number : numbers)
        text += fmt::format("{:<16.{}g} ", row.number(number), numbers.size() == 1 ? 8 : 4);
      text += row.status + (row.failure.empty() ? "" : ": " + row.failure) + "\n";
    }
  } else {
    std::size_t left = 10;  // enough to see what goes wrong
    for (std::size_t i = 0; i < outcome.rows.size() && left > 0; ++i) {
      const SweepRow& row = outcome.rows[i];
      if (row.status == "done") continue;
      text += fmt::format("  {} = {}: {}: {}\n", request.keys[0], outcome.values[i][0], row.status, row.failure);
      --left;
    }
  }
  if (const auto& t = outcome.threshold; t && t->found)
    text += fmt::format(
        "  threshold  {} = {:.10g}, half of {:.2g} either way: {} is {:.6g} at {:.10g}, {:.6g} at {:.10g}\n",
        request.keys[0], 0.5 * (t->low + t->high), t->high - t->low, outcome.number, t->at_low, t->low, t->at_high,
        t->high);
  text += warnings_in_words(outcome.rows);
  if (outcome.status != "done") text += "  status     " + outcome.status + "; the same command goes on from here\n";
  return text;
}

}  // namespace delf
