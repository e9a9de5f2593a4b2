// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lattice/index.hpp"
#include "tools/report/in_words.hpp"
#include "tools/report/text_columns.hpp"
#include "tools/stability/stability_findings.hpp"

namespace delf {

namespace {

constexpr std::size_t widest_line = 120;

std::string courant(const Limit& l, double value, double most) {
  if (!l.left_out.empty() && std::isnan(value)) return "";
  if (std::isnan(value)) return "not found";
  return std::isinf(value) ? fmt::format("none to {:g}", most) : fmt::format("{:.6g}", value);
}

// Remarks on a limit.
std::string remark(const Limit& l) {
  std::string text;
  const auto add = [&](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
  if (!l.left_out.empty()) add(l.left_out);
  if (l.symbol.stable.size() > 1) {
    std::string sets;
    for (const CourantInterval& i : l.symbol.stable) sets += fmt::format(" [{:.4g}, {:.4g}]", i.from, i.to);
    add("stable in" + sets);
  }
  for (const GhostMode& g : l.symbol.ghosts) add(g.words);
  if (!l.unresolved.empty()) {
    const Unresolved& first = l.unresolved.front();
    add(fmt::format("{} h/k unresolved, as {:.4g}: theta = {:.4g}, |z| - 1 = {:.2g}", l.unresolved.size(),
                    first.courant, first.theta, std::expm1(first.growth)));
  }
  if (l.even == Growth::linear && l.odd == Growth::bounded) add("runs: even N grows linearly, odd N does not");
  return text;
}

std::string limits(const StabilityFindings& f) {
  if (f.limits.empty()) return {};
  std::vector<std::vector<std::string>> rows;
  for (const Limit& l : f.limits)
    rows.push_back({l.scheme, l.waves.substr(l.waves.rfind(' ') + 1), courant(l, l.theory, f.most_courant),
                    courant(l, l.observed, f.most_courant),
                    !l.agrees()           ? "FAILED"
                    : !l.left_out.empty() ? "left out"
                    : l.limit_unresolved  ? "unresolved"
                                          : "ok",
                    remark(l)});
  std::string unresolved;
  if (f.unresolved() > 0)
    unresolved = fmt::format(
        "\n  unresolved: waves that grow by theory, but too slowly, or too few of them, for a run of bearable length "
        "to\n"
        "  tell (on {} sites it needs |z| - 1 > {:.2g}). This is neither for nor against theory.\n",
        f.limit_sites, std::expm1(f.least_growth));
  return fmt::format("\n{}", text_table({{"stability limit of"},
                                         {f.own_waves ? "k" : "mh", true},
                                         {"h/k, theory", true},
                                         {"by running", true},
                                         {"verdict"},
                                         {"ghosts and remarks", false, 0, true}},
                                        rows, widest_line)) +
         unresolved;
}

std::string own_left_out(const StabilityFindings& f) {
  std::string text = f.own_left_out.empty() ? "" : "\n";
  for (const std::string& line : wrapped(f.own_left_out, widest_line - 2)) text += "  " + line + "\n";
  return text;
}

std::string constraints(const StabilityFindings& f) {
  if (f.constraints.empty()) return {};
  std::string text = "\nunder the constraint of the scene's theory\n";
  for (const ConstraintFinding& c : f.constraints)
    for (const std::string& line : wrapped(c.scheme + ": " + c.words, widest_line - 2)) text += "  " + line + "\n";
  return text;
}

std::string cell(const StressResult& r) {
  std::string word;
  switch (r.verdict) {
    case StressVerdict::stable:
      word = "ok";
      break;
    case StressVerdict::wrong:
      word = "wrong";
      break;
    case StressVerdict::diverged:
      word = fmt::format("t={:.3g}", r.diverged_at);
      break;
    case StressVerdict::refused:
      word = "refused";
      break;
    case StressVerdict::unstarted:
      word = "-";
      break;
    default:
      word = "FAILED";
  }
  return word + (std::isfinite(r.cut_at) && r.verdict != StressVerdict::unstarted ? "…" : "");
}

// One row for each stress case, one column for each scheme, whose names are numbers that the first line explains.
std::string stress_table(const StabilityFindings& f) {
  if (f.stress_cases.empty()) return {};
  std::vector<std::string> schemes;
  for (const StressFinding& c : f.stress_cases)
    if (std::ranges::find(schemes, c.stress_case.scheme) == schemes.end()) schemes.push_back(c.stress_case.scheme);
  std::vector<TextColumn> columns{{"stress case", false, 34}};
  std::string key;
  for (std::size_t s = 0; s < schemes.size(); ++s) {
    columns.push_back({fmt::format("({})", s + 1)});
    key += fmt::format("{}({}) {}", s == 0 ? "" : ", ", s + 1, schemes[s]);
  }
  std::vector<std::vector<std::string>> rows;
  for (const StressFinding& c : f.stress_cases) {
    if (rows.empty() || rows.back().front() != c.stress_case.name) {
      rows.emplace_back(schemes.size() + 1);
      rows.back().front() = c.stress_case.name;
    }
    const auto at = std::ranges::find(schemes, c.stress_case.scheme) - schemes.begin();
    rows.back()[delf::at(at) + 1] = cell(c.result);
  }
  std::string text = "\n";
  for (const std::string& line : wrapped(key, widest_line - 2)) text += "  " + line + "\n";
  text +=
      "  ok: finite, right; wrong: finite, but not right; t=…: diverged then; refused: delf says that it cannot;\n"
      "  …: cut, for lack of time; -: not started in time. Reasons are in stability.json.\n\n";
  return text + text_table(columns, rows, widest_line);
}

std::string failures(const StabilityFindings& f) {
  std::string text;
  const auto add = [&](const std::string& words) {
    for (const std::string& line : wrapped(words, widest_line - 2)) text += "  " + line + "\n";
  };
  for (const Limit& l : f.limits)
    for (const std::string& d : l.disagreements) {
      text += "\nFAILED: theory and runs disagree\n";
      add(d);
    }
  for (const StressFinding& c : f.stress_cases) {
    if (!must_not_be(c.result.verdict)) continue;
    text +=
        fmt::format("\nFAILED: {}: {}, {}\n", to_string(c.result.verdict), c.stress_case.scheme, c.stress_case.name);
    add(c.result.reason);
    std::string keys;
    for (const Setting& k : keys_of(c.stress_case)) keys += fmt::format(" {}={}", k.key, k.value);
    add("keys:" + keys);
  }
  return text;
}

std::string conclusion(const StabilityFindings& f) {
  std::int64_t compared = 0, refused = 0, wrong = 0;
  for (const Limit& l : f.limits) compared += l.left_out.empty();
  for (const StressFinding& c : f.stress_cases) {
    refused += c.result.verdict == StressVerdict::refused;
    wrong += c.result.verdict == StressVerdict::wrong;
  }
  const std::string counts =
      fmt::format("{} limits compared{}, {} stress cases ({} refused, {} bounded but wrong), in {}", compared,
                  f.unresolved() > 0 ? fmt::format(" ({} h/k unresolved)", f.unresolved()) : "", f.stress_cases.size(),
                  refused, wrong, duration_in_words(f.seconds));
  if (f.status != "done") return fmt::format("not finished ({}): {}\n", f.status, counts);
  if (f.nothing_compared()) return fmt::format("FAILED: nothing could be compared; {}\n", counts);
  if (f.passed()) return fmt::format("passed: {}\n", counts);
  return fmt::format("FAILED: {} disagreements with theory, {} stress cases with a forbidden verdict; {}\n",
                     f.disagreements(), f.must_not_be(), counts);
}

}  // namespace

std::int64_t StabilityFindings::disagreements() const {
  std::int64_t all = 0;
  for (const Limit& l : limits) all += static_cast<std::int64_t>(l.disagreements.size());
  return all;
}

bool StabilityFindings::nothing_compared() const {
  return stress_cases.empty() && std::ranges::none_of(limits, [](const Limit& l) { return l.left_out.empty(); });
}

bool StabilityFindings::not_applicable() const { return status == "done" && nothing_compared() && constraints.empty(); }

std::string StabilityFindings::why_left_out() const {
  std::vector<std::string> reasons;
  for (const Limit& l : limits)
    if (const std::string reason = l.scheme + ": " + l.left_out; std::ranges::find(reasons, reason) == reasons.end())
      reasons.push_back(reason);
  return fmt::format("{}", fmt::join(reasons, "; "));
}

std::int64_t StabilityFindings::unresolved() const {
  std::int64_t all = 0;
  for (const Limit& l : limits) all += static_cast<std::int64_t>(l.unresolved.size());
  return all;
}

std::int64_t StabilityFindings::must_not_be() const {
  return std::ranges::count_if(stress_cases,
                               [](const StressFinding& c) { return delf::must_not_be(c.result.verdict); });
}

std::string stability_report(const Scene& scene, const StabilityFindings& f) {
  return fmt::format(
             "{}: stability of {}; seed {}\n\n"
             "  A scheme is stable up to the h/k of its line, at that {}: by the roots of its symbol, and by steps "
             "from noise.\n"
             "  ok: both agree. Ghosts are waves that grow slowly or not at all, and are no part of the solution.\n",
             scene.name,
             f.own_waves ? "small waves of its own theory about 0" : "phi_tt - phi_xx + m^2 phi = 0, and stress cases",
             f.seed, f.own_waves ? "k" : "mh") +
         limits(f) + own_left_out(f) + constraints(f) + stress_table(f) + failures(f) + "\n" + conclusion(f);
}

}  // namespace delf
