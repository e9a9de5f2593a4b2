// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "jets/tables/named_tables.hpp"
#include "lattice/index.hpp"
#include "tools/files/text_file.hpp"
#include "tools/outcome/findings_json.hpp"
#include "tools/outcome/outcome.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/text_columns.hpp"
#include "tools/scene/suggestion.hpp"
#include "tools/scene/values.hpp"
#include "tools/stability/point_limits.hpp"
#include "tools/stability/stability_request.hpp"

namespace delf {

namespace {

/// The scene's own scheme, then all of mechanics or those that the scene names.
std::vector<NamedScheme> schemes_of(const Scene& scene, const std::vector<std::string>& asked) {
  std::vector<NamedScheme> all = named_schemes(scene.problem), chosen;
  const bool takes_all = asked.empty() || asked == std::vector<std::string>{"all"};
  const std::string own = scheme_label(scene.problem);
  if (!takes_all || std::ranges::find(all, own, &NamedScheme::name) == all.end())
    chosen.push_back({own, scene.problem});
  if (takes_all) {
    std::ranges::move(all, std::back_inserter(chosen));
    return chosen;
  }
  for (const std::string& given : asked) {
    const std::string name = stencil_name(given, true);
    bool any = false;
    for (const NamedScheme& scheme : all)
      if (scheme.name == name || scheme.name.starts_with(name + " ")) add_once(chosen, scheme), any = true;
    if (any) continue;
    std::vector<std::string> names;
    for (const NamedScheme& scheme : all) names.push_back(scheme.name);
    throw scene.settings.error("stability.schemes",
                               fmt::format("{} is no scheme here{}", given, suggestion(given, names)));
  }
  return chosen;
}

std::string limit_in_words(double limit, double most) {
  return std::isnan(limit)   ? "not found"
         : std::isinf(limit) ? fmt::format("none to {:g}", most)
                             : fmt::format("{:.4f}", limit);
}

std::string again(const PointFinding& f) {
  std::string text;
  for (std::size_t i = 1; i < f.stable.size(); ++i)
    text +=
        fmt::format("{}{:.4g} to {:.4g}", i == 1 ? "stable again from " : ", ", f.stable[i].first, f.stable[i].second);
  return text;
}

std::vector<std::string> cells(const PointFinding& f, const PointRequest& request) {
  return {f.scheme,
          fmt::format("{:.2f}", f.order),
          limit_in_words(f.theory, request.most),
          limit_in_words(f.observed, request.most),
          fmt::format("{:.2f}", f.microseconds),
          fmt::format("{:.1f}", f.iterations),
          !f.agrees      ? "FAILED"
          : f.too_narrow ? again(f) + "; too narrow for runs"
                         : again(f)};
}

const std::vector<std::string> headings{"scheme",    "order",      "wh, theory", "by running",
                                        "us a step", "iterations", "remarks"};

std::string markdown(const std::vector<PointFinding>& findings, const PointRequest& request) {
  std::string text, rule;
  for (const std::string& heading : headings) text += "| " + heading + " ", rule += "|---";
  text += "|\n" + rule + "|\n";
  for (const PointFinding& f : findings) {
    for (const std::string& cell : cells(f, request)) text += "| " + cell + " ";
    text += "|\n";
  }
  return text;
}

std::string json_of(const Scene& scene, const std::vector<PointFinding>& findings, const PointRequest& request) {
  Json json = json_head(scene);
  json["most_frequency_step"] = request.most;
  json["agreement"] = request.agreement;
  json["point_limits"] = json_list(findings, [](const PointFinding& f) {
    return Json{{"scheme", f.scheme},
                {"theory", f.theory},
                {"observed", f.observed},
                {"unlimited", std::isinf(f.theory)},
                {"stable", json_list(f.stable,
                                     [](const auto& interval) {
                                       return Json::array({interval.first, interval.second});
                                     })},
                {"agrees", f.agrees},
                {"order", f.order},
                {"microseconds", f.microseconds},
                {"iterations", f.iterations}};
  });
  return json_text(json);
}

}  // namespace

PointRequest point_request(const Scene& scene) {
  const Values values(scene.settings);
  PointRequest request;
  request.agreement = values.real("stability.agreement");
  request.steps = static_cast<int>(values.integer("stability.steps"));
  if (values.choice("stability.fault") == "limit") request.theory_factor = 1.05;
  return request;
}

ExitCode point_stability(const Scene& scene, const std::filesystem::path& folder) {
  const Interrupt interrupt;
  PointRequest request = point_request(scene);
  request.schemes = schemes_of(scene, listed_names(scene, "stability.schemes"));
  if (scene.settings.find("stability.most_courant"))
    request.most = Values(scene.settings).real("stability.most_courant");
  std::vector<PointFinding> findings;
  std::string left_out;
  int count_left_out = 0;
  for (const NamedScheme& scheme : request.schemes) {
    if (Interrupt::asked()) break;
    PointFinding found = find_point_limit(scheme, request);
    if (Interrupt::asked()) break;  // it is half done
    if (found.left_out.empty()) findings.push_back(std::move(found));
    else left_out += "  " + shortened(found.scheme + ": " + found.left_out, 118) + "\n", ++count_left_out;
  }
  make_results_folder(folder);
  write_text_file(folder / "stability.json", json_of(scene, findings, request));
  write_text_file(folder / "methods.md", markdown(findings, request));
  std::vector<TextColumn> columns;
  for (const std::string& heading : headings) columns.push_back({heading, heading != "scheme" && heading != "remarks"});
  std::vector<std::vector<std::string>> rows;
  for (const PointFinding& f : findings) rows.push_back(cells(f, request));
  fmt::print("{}: limits on q_tt = -w^2 q; order and cost on a pendulum\n\n{}", scene.name,
             text_table(columns, rows, 120));
  if (scene.settings.find("stability.schemes") && count_left_out > 0) fmt::print("\nleft out\n{}", left_out);
  else if (count_left_out > 0) fmt::print("\nleft out: {} schemes that are not of mechanics\n", count_left_out);
  if (Interrupt::asked()) {
    fmt::print("\nnot finished (interrupted): {} of {} schemes\n{}: stability.json methods.md\n",
               findings.size() + at(count_left_out), request.schemes.size(), folder.string());
    return ExitCode::interrupted;
  }
  const auto failed = std::ranges::count(findings, false, &PointFinding::agrees);
  fmt::print("\n{} of {} limits agree\n{}: stability.json methods.md\n", findings.size() - at(failed), findings.size(),
             folder.string());
  return failed == 0 ? ExitCode::done : ExitCode::check_failed;
}

}  // namespace delf
