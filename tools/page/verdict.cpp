// SPDX-License-Identifier: MIT
#include "tools/page/verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "tools/page/numbers.hpp"
#include "tools/results/same_scene.hpp"

namespace delf {
namespace {

std::string counted(double count, const char* what) {
  return fmt::format("{} {}{}", number_text(count), what, count == 1 ? "" : "s");
}

/// The status of a run that failed, in words.
std::string failure_in_words(const std::string& status) {
  static const std::map<std::string, std::string> words{{"no-convergence", "a step could not be solved"},
                                                        {"not-finite", "a value became infinite, or not a number"},
                                                        {"mesh-crossing", "sites of the moving mesh passed each other"},
                                                        {"system-failure", "the disk or the memory failed"}};
  const auto found = words.find(status);
  return found == words.end() ? "its status is " + status : found->second;
}

/// The way on for a run that did not end.
std::string way_on(const ResultFolder& folder) {
  return folder.has_file("checkpoint") || folder.has_file("checkpoint.previous")
             ? "`delf resume` goes on with it from its last checkpoint."
             : "It has no checkpoint to go on from: run it anew.";
}

PageVerdict run_verdict(const ResultFolder& folder) {
  const Json* summary = folder.result("summary");
  const std::string status = text_in(summary, "status");
  std::string until;  // of a problem without time nothing
  if (const auto time = number_in(summary, "time"); time && number_in(summary, "steps").value_or(0) > 0)
    until = fmt::format(" after {}, at t = {}", counted(number_in(summary, "steps").value_or(0), "step"),
                        number_text(time));
  PageVerdict verdict{false, {}, texts_in(summary, "warnings")};
  if (status == "interrupted") verdict.sentence = fmt::format("The run was interrupted{}. {}", until, way_on(folder));
  else if (status != "done") {
    verdict.sentence = fmt::format("The run failed{}: {}. Its rows are good up to the last one recorded.", until,
                                   failure_in_words(status));
    if (const std::string why = text_in(summary, "failure"); !why.empty())
      verdict.points.insert(verdict.points.begin(), why);
  } else if (verdict.points.empty()) {
    const auto beyond = std::ranges::count(numbers_of(folder), true, &PageNumber::worrying);
    verdict.good = true;
    verdict.sentence = fmt::format("The run ended well{}, without a warning", until);
    verdict.sentence += beyond == 0   ? "."
                        : beyond == 1 ? ", but a number is beyond what is usual: see Numbers."
                                      : fmt::format(", but {} numbers are beyond what is usual: see Numbers.", beyond);
  } else
    verdict.sentence = fmt::format(
        "The run ended{}, but its result may be wrong: there {}.", until,
        verdict.points.size() == 1 ? "is a warning" : fmt::format("are {} warnings", verdict.points.size()));
  return verdict;
}

/// Wrong derivatives make equations fail, and wrong equations make the formulas fail that follow from them.
int rank_of_cause(const std::string& check) {
  return check.starts_with("derivatives") ? 0 : check.starts_with("field equations") ? 1 : 2;
}

PageVerdict verification_verdict(const ResultFolder& folder) {
  const Json* verify = folder.result("verify");
  PageVerdict verdict;
  if (const std::vector<std::string> others = other_scene(folder); !others.empty()) {
    verdict.sentence =
        "The verification in this folder is of another scene, and is not counted. `delf verify scene.ini` verifies this "
        "one.";
    verdict.points = others;
    return verdict;
  }
  std::vector<Json> checks = list_in(verify, "checks"), failed;
  for (const Json& check : checks)
    if (!is_true_in(&check, "passed")) failed.push_back(check);
  const bool interrupted = text_in(verify, "status") == "interrupted";
  verdict.good = is_true_in(verify, "passed") && failed.empty() && !checks.empty() && !interrupted;
  const std::string rows = text_in(verify, "subject");
  if (checks.empty()) verdict.sentence = fmt::format("Nothing was checked of {}.", rows.empty() ? "these rows" : rows);
  else if (!failed.empty())
    verdict.sentence = fmt::format("Verification failed: {} of {} checks do{} not hold for {}.", failed.size(),
                                   checks.size(), failed.size() == 1 ? "es" : "", rows);
  else if (interrupted) verdict.sentence = fmt::format("{0} of {0} checks passed so far for {1}.", checks.size(), rows);
  else if (verdict.good)
    verdict.sentence = fmt::format("Verification passed: all {} checks hold for {}.", checks.size(), rows);
  else
    verdict.sentence =
        fmt::format("Verification did not pass, though all {} checks that verify.json has hold.", checks.size());
  if (interrupted) verdict.sentence += " It was interrupted, and is not finished.";
  for (const Json& finding : list_in(verify, "diagnosis"))
    verdict.points.push_back("Diagnosis: " + text_in(&finding, "words"));
  std::ranges::stable_sort(failed, {}, [](const Json& c) { return rank_of_cause(text_in(&c, "name")); });
  for (std::size_t n = 0; n < failed.size(); ++n) {
    std::string name = text_in(&failed[n], "name"), why = text_in(&failed[n], "failure");
    if (why.empty()) why = "it could not be measured: " + text_in(&failed[n], "unmeasurable");
    const std::string kind = name.substr(0, name.find(','));  // of the form formula on one kind of region
    std::size_t alike = 1;
    while (n + 1 < failed.size() && text_in(&failed[n + 1], "name").starts_with(kind + ",")) ++n, ++alike;
    verdict.points.push_back(
        fmt::format("{}{}: {}", name, alike == 1 ? "" : fmt::format(" and {} alike", alike - 1), why));
  }
  return verdict;
}

PageVerdict convergence_verdict(const ResultFolder& folder) {
  const Json* convergence = folder.result("convergence");
  const auto order = number_in(convergence, "order");
  const auto of_scheme = number_in(convergence, "order_of_scheme"), expected = number_in(convergence, "order_expected");
  const std::string status = text_in(convergence, "status"),
                    asked = expected    ? fmt::format(", where {} was expected", number_text(expected))
                            : of_scheme ? fmt::format(", and the scheme's is {}", number_text(of_scheme))
                                        : ", and the scheme declares none";
  PageVerdict verdict;
  verdict.good =
      is_true_in(convergence, "passed") && status == "done" && order && text_in(convergence, "verdict") == "passed";
  verdict.sentence = order ? fmt::format("The order of convergence is {}{}", number_text(order), asked)
                           : fmt::format("The order of convergence was not measured{}", asked);
  if (status == "interrupted")
    verdict.sentence += fmt::format(". It was interrupted after {}, and is not finished.",
                                    counted(static_cast<double>(list_in(convergence, "levels").size()), "line"));
  else if (order && (expected || of_scheme)) verdict.sentence += fmt::format(": {}.", text_in(convergence, "verdict"));
  else verdict.sentence += ".";
  for (const char* key : {"reason", "ended"})
    if (const std::string why = text_in(convergence, key); !why.empty()) verdict.points.push_back(why);
  return verdict;
}

PageVerdict sweep_verdict(const ResultFolder& folder) {
  const Json* sweep = folder.result("sweep");
  std::size_t well = 0, warned = 0;
  PageVerdict verdict;
  const std::vector<Json> runs = list_in(sweep, "runs");
  for (const Json& run : runs) {
    const std::string status = text_in(&run, "status");
    if (status == "done") ++well;
    const auto summary = run.is_object() ? run.find("summary") : run.end();
    const auto warnings = summary == run.end() ? std::vector<std::string>() : texts_in(&*summary, "warnings");
    if (status == "done" && warnings.empty()) continue;
    if (!warnings.empty()) ++warned;
    std::string name = text_in(&run, "folder");
    if (name.empty()) name = "a run whose files were not kept";
    verdict.points.push_back(fmt::format(
        "{}: {}", name,
        status != "done"
            ? failure_in_words(status)
            : warnings[0] + (warnings.size() == 1 ? "" : fmt::format(" (and {} more)", warnings.size() - 1))));
  }
  verdict.good = well == runs.size() && !runs.empty() && warned == 0 && text_in(sweep, "status") == "done";
  verdict.sentence = fmt::format("{} of {} runs ended well.", well, number_text(number_in(sweep, "runs_asked")));
  if (warned > 0)
    verdict.sentence +=
        fmt::format(" Results of {} may be wrong: there are warnings.", counted(static_cast<double>(warned), "run"));
  if (text_in(sweep, "status") == "interrupted") verdict.sentence += " The sweep was interrupted.";
  return verdict;
}

PageVerdict workprecision_verdict(const ResultFolder& folder) {
  const Json* json = folder.result("workprecision");
  PageVerdict verdict{text_in(json, "status") == "done", {}, {}};
  verdict.sentence =
      fmt::format("{} were compared by {}, with errors against {}.",
                  counted(static_cast<double>(list_in(json, "schemes").size()), "scheme"),
                  counted(static_cast<double>(list_in(json, "runs").size()), "run"), text_in(json, "reference"));
  if (!verdict.good) verdict.sentence += " The comparison was interrupted.";
  return verdict;
}

PageVerdict stability_verdict(const ResultFolder& folder) {
  const Json* json = folder.result("stability");
  std::vector<Json> limits = list_in(json, "limits");
  const std::vector<Json> of_points = list_in(json, "point_limits"), cases = list_in(json, "corners");
  limits.insert(limits.end(), of_points.begin(), of_points.end());
  const bool interrupted = text_in(json, "status") == "interrupted";
  const auto agree = std::ranges::count_if(limits, [](const Json& limit) { return is_true_in(&limit, "agrees"); });
  // meshes and points have no other outcome than their limits
  const bool passed = json->contains("passed") ? is_true_in(json, "passed") : agree == std::ssize(limits);
  PageVerdict verdict{passed && !interrupted, {}, {}};
  verdict.sentence =
      interrupted ? fmt::format("{} of {} passed so far, and {} were tried. It was interrupted, and is not finished.",
                                agree, counted(static_cast<double>(limits.size()), "limit"),
                                counted(static_cast<double>(cases.size()), "stress case"))
                  : fmt::format("Stability {}: {} of theory were compared with runs, and {} were tried.",
                                passed ? "passed" : "failed", counted(static_cast<double>(limits.size()), "limit"),
                                counted(static_cast<double>(cases.size()), "stress case"));
  for (const Json& limit : limits)
    for (const std::string& against : texts_in(&limit, "disagreements"))
      verdict.points.push_back(fmt::format("{}, {}: {}", text_in(&limit, "scheme"), text_in(&limit, "waves"), against));
  return verdict;
}

}  // namespace

std::vector<PageVerdict> verdicts_of(const ResultFolder& folder) {
  static const std::map<std::string, PageVerdict (*)(const ResultFolder&)> all{
      {"summary", run_verdict}, {"verify", verification_verdict},         {"convergence", convergence_verdict},
      {"sweep", sweep_verdict}, {"workprecision", workprecision_verdict}, {"stability", stability_verdict}};
  std::vector<PageVerdict> verdicts;
  for (const std::string& kind : ResultFolder::kinds())
    if (folder.result(kind)) verdicts.push_back(all.at(kind)(folder));
    else if (folder.damaged.contains(kind))
      verdicts.push_back({false, fmt::format("{}.json is damaged, and its results are not known.", kind), {}});
  if (verdicts.empty() && !folder.series.columns.empty())
    verdicts.push_back({false,
                        fmt::format("The run has not ended, or was killed: series.csv has {}, to t = {}.",
                                    counted(static_cast<double>(folder.series.columns.front().size()), "row"),
                                    number_text(folder.series.column("time")->back())),
                        {"If it is not under way: " + way_on(folder)}});
  if (verdicts.empty()) verdicts.push_back({false, "There are no results here yet, but only a scene.", {}});
  return verdicts;
}

}  // namespace delf
