// SPDX-License-Identifier: MIT
#include "tools/page/verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

namespace delf {
namespace {

/// The status of a run that failed, in words.
std::string failure_in_words(const std::string& status) {
  static const std::map<std::string, std::string> words{{"no-convergence", "a step could not be solved"},
                                                        {"not-finite", "a value became infinite, or not a number"},
                                                        {"mesh-crossing", "sites of the moving mesh passed each other"},
                                                        {"system-failure", "the disk or the memory failed"}};
  const auto found = words.find(status);
  return found == words.end() ? "its status is " + status : found->second;
}

PageVerdict of_run(const Json* summary) {
  const std::string status = text_in(summary, "status");
  std::string until;  // of a problem without time nothing
  if (const auto time = number_in(summary, "time"); time && number_in(summary, "steps").value_or(0) > 0)
    until = fmt::format(" after {} steps, at t = {}", number_text(number_in(summary, "steps")), number_text(time));
  PageVerdict verdict{false, {}, texts_in(summary, "warnings")};
  if (status == "interrupted")
    verdict.sentence = fmt::format("The run was interrupted{}. `delf resume` goes on with it.", until);
  else if (status != "done") {
    verdict.sentence = fmt::format("The run failed{}: {}. Its rows are good up to the last one recorded.", until,
                                   failure_in_words(status));
    if (const std::string why = text_in(summary, "failure"); !why.empty())
      verdict.points.insert(verdict.points.begin(), why);
  } else if (verdict.points.empty()) {
    verdict.good = true;
    verdict.sentence = fmt::format("The run ended well{}, without a warning.", until);
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

PageVerdict of_verification(const Json* verify) {
  std::vector<Json> checks = list_in(verify, "checks"), failed;
  for (const Json& check : checks)
    if (!is_true_in(&check, "passed")) failed.push_back(check);
  PageVerdict verdict;
  verdict.good = is_true_in(verify, "passed");
  const std::string rows = text_in(verify, "subject");
  if (failed.empty())
    verdict.sentence = fmt::format("Verification passed: all {} checks hold for {}.", checks.size(), rows);
  else
    verdict.sentence =
        fmt::format("Verification failed: {} of {} checks do not hold for {}.", failed.size(), checks.size(), rows);
  if (text_in(verify, "status") == "interrupted") verdict.sentence += " It was interrupted.";
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

PageVerdict of_convergence(const Json* convergence) {
  const std::string order = number_text(number_in(convergence, "order"));
  const auto of_scheme = number_in(convergence, "order_of_scheme"), expected = number_in(convergence, "order_expected");
  PageVerdict verdict{is_true_in(convergence, "passed"), {}, {}};
  verdict.sentence =
      fmt::format("The order of convergence {}{}: {}.", order.empty() ? "was not measured" : "is " + order,
                  expected    ? fmt::format(", where {} was expected", number_text(expected))
                  : of_scheme ? fmt::format(", and the scheme's is {}", number_text(of_scheme))
                              : "",
                  text_in(convergence, "verdict"));
  for (const char* key : {"reason", "ended"})
    if (const std::string why = text_in(convergence, key); !why.empty()) verdict.points.push_back(why);
  return verdict;
}

PageVerdict of_sweep(const Json* sweep) {
  std::size_t well = 0;
  PageVerdict verdict;
  const std::vector<Json> runs = list_in(sweep, "runs");
  for (const Json& run : runs) {
    const std::string status = text_in(&run, "status");
    if (status == "done") ++well;
    else verdict.points.push_back(fmt::format("{}: {}", text_in(&run, "folder"), failure_in_words(status)));
  }
  verdict.good = well == runs.size() && !runs.empty() && text_in(sweep, "status") == "done";
  verdict.sentence = fmt::format("{} of {} runs ended well.", well, number_text(number_in(sweep, "runs_asked")));
  if (text_in(sweep, "status") == "interrupted") verdict.sentence += " The sweep was interrupted.";
  return verdict;
}

PageVerdict of_workprecision(const Json* json) {
  PageVerdict verdict{text_in(json, "status") == "done", {}, {}};
  verdict.sentence =
      fmt::format("{} schemes were compared by {} runs, with errors against {}.", list_in(json, "schemes").size(),
                  list_in(json, "runs").size(), text_in(json, "reference"));
  if (!verdict.good) verdict.sentence += " The comparison was interrupted.";
  return verdict;
}

PageVerdict of_stability(const Json* json) {
  const std::vector<Json> limits = list_in(json, "limits"), cases = list_in(json, "corners");
  PageVerdict verdict{is_true_in(json, "passed"), {}, {}};
  verdict.sentence = fmt::format(
      "Stability {}: {} limits of theory were compared with runs, and {} stress cases were tried.",
      verdict.good ? "passed" : "failed", limits.size() + list_in(json, "point_limits").size(), cases.size());
  for (const Json& limit : limits)
    for (const std::string& against : texts_in(&limit, "disagreements"))
      verdict.points.push_back(fmt::format("{}, {}: {}", text_in(&limit, "scheme"), text_in(&limit, "waves"), against));
  return verdict;
}

}  // namespace

std::vector<PageVerdict> verdicts_of(const ResultFolder& folder) {
  static const std::map<std::string, PageVerdict (*)(const Json*)> all{
      {"summary", of_run}, {"verify", of_verification},         {"convergence", of_convergence},
      {"sweep", of_sweep}, {"workprecision", of_workprecision}, {"stability", of_stability}};
  std::vector<PageVerdict> verdicts;
  for (const std::string& kind : ResultFolder::kinds())
    if (const Json* json = folder.result(kind)) verdicts.push_back(all.at(kind)(json));
  if (verdicts.empty() && !folder.series.empty())
    verdicts.push_back({false,
                        fmt::format("The run has not ended, or was killed: series.csv has {} rows, to t = {}.",
                                    folder.series.front().size(), number_text(folder.column("time")->back())),
                        {"If it is not under way, `delf resume` goes on with it from its last checkpoint."}});
  if (verdicts.empty()) verdicts.push_back({false, "There are no results here yet, but only a scene.", {}});
  return verdicts;
}

}  // namespace delf
