// SPDX-License-Identifier: MIT
#include "tools/reproduce/reproduce.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <thread>

#include "tools/files/csv_cell.hpp"
#include "tools/files/folder_lock.hpp"
#include "tools/files/logged_process.hpp"
#include "tools/files/text_file.hpp"
#include "tools/outcome/findings_json.hpp"
#include "tools/page/markup.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/seconds_since.hpp"
#include "tools/report/text_columns.hpp"
#include "tools/reproduce/command_pool.hpp"
#include "tools/reproduce/reproduction.hpp"
#include "tools/scene/values.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

constexpr Reproduced verdicts[] = {Reproduced::yes, Reproduced::misprint, Reproduced::differs, Reproduced::failed};
constexpr std::size_t width = 120;

// An equation is too long for a table.
std::string expected_words(const PublishedResult& result) {
  if (result.number == "equation") return "coefficients";
  const bool of_bounds = result.expected.find_first_of("<>") == 0 || result.expected.find(" to ") != std::string::npos;
  return of_bounds || result.tolerance.empty() ? result.expected
                                               : fmt::format("{} ± {}", result.expected, result.tolerance);
}
std::string value_words(const Reproduction& r) {
  if (std::isnan(r.value)) return "none";
  return r.result.number == "equation" ? fmt::format("{:.1e} off", r.value) : fmt::format("{:.6g}", r.value);
}

/// The results of a kind, those of them that are reproduced, and those whose source was not at hand.
struct KindCount {
  std::string kind;
  std::ptrdiff_t results = 0, reproduced = 0, unchecked = 0;
};
std::vector<KindCount> counts_of_kinds(const std::vector<Reproduction>& all) {
  std::vector<KindCount> counts;
  for (const std::string& kind : kinds_of_results) {
    KindCount count{kind};
    for (const Reproduction& r : all)
      if (r.result.kind == kind)
        ++count.results, count.reproduced += r.verdict == Reproduced::yes,
            count.unchecked += r.result.checked.starts_with("not checked");
    counts.push_back(count);
  }
  return counts;
}

/// "reproduced 38 of 44 printed (9 not checked in the source), 50 of 50 derived; misprinted 4, different 2, failed 0"
std::string count_words(const std::vector<Reproduction>& all) {
  std::map<Reproduced, std::size_t> counts;
  for (const Reproduction& r : all) ++counts[r.verdict];
  std::string text;
  for (const KindCount& c : counts_of_kinds(all))
    if (c.results > 0)
      text += fmt::format("{} {} of {} {}{}", text.empty() ? "reproduced" : ",", c.reproduced, c.results, c.kind,
                          c.unchecked > 0 ? fmt::format(" ({} not checked in the source)", c.unchecked) : "");
  return fmt::format("{}; misprinted {}, different {}, failed {}", text.empty() ? "reproduced none" : text,
                     counts[Reproduced::misprint], counts[Reproduced::differs], counts[Reproduced::failed]);
}

void print_table(const std::vector<Reproduction>& all) {
  std::vector<std::vector<std::string>> rows;
  for (const Reproduction& r : all)
    rows.push_back(
        {r.result.id, r.result.where, r.result.kind, expected_words(r.result), value_words(r), words_of(r.verdict)});
  fmt::print(
      "{}", text_table(
                {{"result"}, {"where", false, 0, true}, {"kind"}, {"expected", false, 30}, {"here", true}, {"verdict"}},
                rows, width));
  for (const Reproduced verdict : {Reproduced::misprint, Reproduced::differs, Reproduced::failed})
    for (const Reproduction& r : all)
      if (r.verdict == verdict) fmt::print("  {}, {}: {}\n", r.result.id, words_of(verdict), r.reason);
  fmt::print("  {}\n", count_words(all));
}

Json json_of(const Reproduction& r) {
  const PublishedResult& p = r.result;
  return {{"id", p.id},
          {"title", p.title},
          {"paper", p.paper},
          {"reference", p.reference},
          {"doi", text_or_null(p.doi)},
          {"where", p.where},
          {"checked", p.checked},
          {"command", r.command},
          {"number", p.number},
          {"kind", p.kind},
          {"expected", p.expected},
          {"correct", text_or_null(p.correct)},
          {"tolerance", text_or_null(p.tolerance)},
          {"because", text_or_null(p.because)},
          {"value", std::isfinite(r.value) ? Json(r.value) : Json()},
          {"verdict", words_of(r.verdict)},
          {"reason", text_or_null(r.reason)},
          {"seconds", r.seconds}};
}

std::string csv_of(const std::vector<Reproduction>& all) {
  std::string text = "id,paper,where,kind,expected,tolerance,value,verdict,reason,seconds\n";
  for (const Reproduction& r : all)
    text += fmt::format("{},{},{},{},{},{},{},{},{},{:.3f}\n", csv_cell(r.result.id), csv_cell(r.result.paper),
                        csv_cell(r.result.where), r.result.kind, csv_cell(r.result.expected),
                        csv_cell(r.result.tolerance), std::isnan(r.value) ? "" : fmt::format("{:.17g}", r.value),
                        words_of(r.verdict), csv_cell(r.reason), r.seconds);
  return text;
}

/// The page: the table of each paper, and below it each result with its command.
std::string page_of(const std::vector<Reproduction>& all, bool interrupted) {
  const bool good = std::ranges::none_of(all, [](const auto& r) { return r.verdict == Reproduced::failed; });
  std::string html = fmt::format(
      "<h1>Published results, computed again</h1>\n<div class=\"verdict{}\"><p><strong>{}</strong> "
      "{}.{}</p></div>\n",
      good && !interrupted ? " good" : "", good && !interrupted ? "Good." : "Attention.", escaped(count_words(all)),
      interrupted ? " Interrupted: the others are missing." : "");
  html += paragraph(fmt::format("delf {}, {}, {}.", DELF_VERSION, machine_in_words(), compiler_in_words()));
  html += paragraph(
      "Kinds of expected values: a printed one is in the source, in numbers or words; a drawn one is in a figure of it, "
      "without a number; a derived one is not in the source, and comes from a closed formula, from theory or from an "
      "independent program.");
  for (auto first = all.begin(); first != all.end();) {
    const PublishedResult& p = first->result;
    const auto last = std::find_if(first, all.end(), [&](const Reproduction& r) { return r.result.paper != p.paper; });
    PageTable t{"Expected, and computed here",
                {"result", "where", "kind", "expected", "here", "verdict", "reason, or the reason of the tolerance"},
                {}};
    std::string commands;
    for (auto r = first; r != last; ++r) {
      t.rows.push_back({r->result.title, r->result.where, r->result.kind, expected_words(r->result), value_words(*r),
                        words_of(r->verdict), r->reason.empty() ? r->result.because : r->reason});
      commands += fmt::format("# {} ({:.2f} s; {} value: {})\n{}\n", r->result.id, r->seconds, r->result.kind,
                              r->result.checked, r->command);
      if (r->result.number == "equation") commands += fmt::format("# {}: {}\n", r->result.kind, r->result.expected);
    }
    html += section(p.paper, p.paper,
                    paragraph(p.reference + (p.doi.empty() ? "" : ", doi:" + p.doi)) + table(t) +
                        details("Commands", code_block("The commands of these results", commands)));
    first = last;
  }
  return document("Published results, computed again by delf", html);
}

void write_results(const std::vector<Reproduction>& all, bool interrupted, double seconds, const fs::path& folder) {
  Json json{{"version", DELF_VERSION}, {"machine", machine_in_words()}, {"compiler", compiler_in_words()}};
  json["status"] = interrupted ? "interrupted" : "done";
  json["seconds"] = seconds;
  for (const Reproduced verdict : verdicts)
    json[words_of(verdict)] = std::ranges::count(all, verdict, &Reproduction::verdict);
  for (const KindCount& c : counts_of_kinds(all))
    json["kinds"][c.kind] = {{"results", c.results}, {"reproduced", c.reproduced}, {"not_checked", c.unchecked}};
  json["results"] = json_list(all, json_of);
  write_text_file(folder / "results.json", json_text(json));
  write_text_file(folder / "results.csv", csv_of(all));
  write_text_file(folder / "report.html", page_of(all, interrupted));
}

/// Removes what an earlier call has left: files of these names, and the folders of published results.
void remove_earlier(const fs::path& folder) {
  std::error_code none;
  for (const char* file : {"results.json", "results.csv", "report.html"}) fs::remove(folder / file, none);
  for (const PublishedResult& result : published_results()) fs::remove_all(folder / "runs" / result.id, none);
}

/// The command of a result, in an empty folder but for its scene.
PooledCommand prepared(const PublishedResult& result, const fs::path& folder, const std::vector<Setting>& keys) {
  if (!result.scene.empty()) {
    make_results_folder(folder / "scene");
    write_text_file(folder / "scene" / (result.id + ".ini"), result.scene + "\n");
  }
  return {words_for(result, folder, keys), folder};
}

}  // namespace

ExitCode reproduce(const std::vector<std::string>& names, const std::vector<Setting>& keys,
                   const std::optional<std::string>& out, ExitCode (*program)(const std::vector<std::string>&)) {
  const auto begin = std::chrono::steady_clock::now();
  check_command_line(keys);
  std::vector<Setting> own, passed_on;
  for (const Setting& key : keys) (section_of(key.key) == "reproduce" ? own : passed_on).push_back(key);
  const Settings settings("", {}, own);
  const Values values(settings);
  const std::vector<PublishedResult> chosen = chosen_results(names, values.choice("reproduce.slow"));
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int jobs = values.given("reproduce.jobs") ? static_cast<int>(values.integer("reproduce.jobs")) : cores;
  const fs::path folder = out.value_or("results/reproduce");
  make_results_folder(folder);
  const FolderLock held(folder);
  const Interrupt interrupt;

  remove_earlier(folder);
  std::vector<PooledCommand> commands;
  std::map<std::string, std::size_t> places;  // of commands: several numbers may come from one
  std::vector<std::size_t> command_of;        // each result
  for (const PublishedResult& result : chosen) {
    const auto [place, is_new] = places.emplace(result.command + " " + result.keys + result.scene, commands.size());
    command_of.push_back(place->second);
    if (is_new) commands.push_back(prepared(result, folder / "runs" / result.id, passed_on));
  }
  std::map<std::size_t, Reproduction> found;  // by the place of the result
  std::size_t refused = 0;
  std::string refusal;
  carry_out_side_by_side(commands, jobs, program, [&](std::size_t c, int code, double seconds) {
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (command_of[i] != c) continue;
      Reproduction one = judged(chosen[i], commands[c].words, commands[c].folder, code, passed_on);
      one.seconds = seconds;
      found.emplace(i, std::move(one));
    }
    if (code == static_cast<int>(ExitCode::bad_input) && refused++ == 0) refusal = error_in_log(commands[c].folder);
  });
  // Keys that every command refuses are at fault, and no result is.
  if (!passed_on.empty() && refused == commands.size()) throw BadScene(refusal);
  std::vector<Reproduction> all;
  for (auto& [place, one] : found) all.push_back(std::move(one));
  const bool interrupted = all.size() < chosen.size();
  write_results(all, interrupted, seconds_since(begin), folder);
  print_table(all);
  fmt::print("{}: results.json results.csv report.html runs\n", folder.string());
  if (interrupted) return ExitCode::interrupted;
  const bool failed = std::ranges::count(all, Reproduced::failed, &Reproduction::verdict) > 0;
  return failed ? ExitCode::check_failed : ExitCode::done;
}

void list_results() {
  for (const PublishedResult& r : published_results())
    fmt::print("  {:<34} {}{}, {}\n", r.id, r.slow ? "(slow) " : "", r.title, r.where);
}

}  // namespace delf
