// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <vector>

#include "tools/outcome/outcome.hpp"
#include "tools/report/in_words.hpp"
#include "tools/report/text_columns.hpp"
#include "tools/verify/verdict.hpp"

namespace delf {

namespace {

constexpr std::size_t widest_line = 120, widest_name = 44, widest_failure = 100;

// "  name       what", and what does not fit below it.
std::string header_line(const char* name, const std::string& what) {
  std::string text;
  for (const std::string& part : wrapped(what, widest_line - 13))
    text += fmt::format("  {:<10} {}\n", text.empty() ? name : "", part);
  return text;
}

std::string header(const Subject& subject, const Scene& scene, const Verdict& v) {
  const Problem& p = scene.problem;
  return fmt::format("{}: {}{}\n", scene.name, p.theory, p.circle_valued ? ", values in S1" : "") +
         header_line("scheme", subject.scheme) + header_line("subject", v.subject) +
         header_line("verified",
                     fmt::format("{} stencils in {}, seed {}", v.stencils, duration_in_words(v.seconds), v.seed)) +
         header_line("status", v.status);
}

std::string number(double value) {
  if (std::isnan(value)) return "no number";
  return std::isinf(value) ? "infinite" : fmt::format("{:.3g}", value);
}

std::string table_of_checks(const Verdict& v) {
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const Check& c, const char* verdict) {
    rows.push_back(
        {c.name, number(c.value), fmt::format("{:.2g}", c.tolerance), fmt::format("{}", c.count), c.region, verdict});
  };
  for (const Check& c : v.checks) add(c, c.passed() ? "ok" : "FAILED");
  for (const Unmeasured& u : v.unmeasured) add(u.check, "not measurable");
  if (rows.empty()) return {};
  return fmt::format("\n{}", text_table({{"check", false, widest_name},
                                         {"largest", true},
                                         {"tolerance", true},
                                         {"count", true},
                                         {"where", false, 0, true},
                                         {"verdict"}},
                                        rows, widest_line));
}

std::string table_of_measured(const Verdict& v) {
  std::vector<std::vector<std::string>> rows;
  for (const Measured& m : v.measured)
    rows.push_back({m.name, number(m.value), std::isfinite(m.order) ? fmt::format("{:.2f}", m.order) : "",
                    m.region + (m.region.empty() || m.remark.empty() ? "" : "; ") + m.remark});
  if (rows.empty()) return {};
  return fmt::format("\n{}", text_table({{"measured, not promised", false, widest_name},
                                         {"value", true},
                                         {"order in h", true},
                                         {"where", false, 0, true}},
                                        rows, widest_line));
}

std::string left_out(const Verdict& v) {
  std::string text;
  for (const std::string& what : v.left_out) {
    bool first = true;
    for (const std::string& part : wrapped(what, widest_failure - 6)) {
      text += (first ? "    " : "      ") + part + "\n";
      first = false;
    }
  }
  return text.empty() ? text : "\n  left out\n" + text;
}

std::string without_numbers(const std::string& words) {
  static const std::regex number("-?[0-9]+([.][0-9]+)?(e[-+][0-9]+)?");
  return std::regex_replace(words, number, "#");
}

// Failures that differ in numbers alone are explained once, by the first of them.
std::string failures(const Verdict& v) {
  struct Alike {
    std::string words, names;
    bool same = true;  // to the last digit
  };
  std::vector<Alike> all;
  for (const Check& c : v.checks) {
    if (c.passed()) continue;
    const std::string words = !c.failure.empty()    ? c.failure
                              : std::isnan(c.value) ? "What was found is not a number."
                                                    : fmt::format("{:.3g} is above {:.2g}.", c.value, c.tolerance);
    const std::string name = "FAILED: " + shortened(c.name, widest_line - 8) + "\n";
    const auto known =
        std::ranges::find(all, without_numbers(words), [](const Alike& a) { return without_numbers(a.words); });
    if (known == all.end()) all.push_back({words, name});
    else known->names += name, known->same = known->same && known->words == words;
  }
  std::string text;
  for (const Alike& a : all) {
    text += "\n" + a.names;
    for (const std::string& part : wrapped(a.words, widest_failure - 2)) text += "  " + part + "\n";
    if (!a.same)
      text += "  This is the first; the others fail alike, where the table says. verify.json has each in full.\n";
  }
  return text;
}

std::string unmeasured(const Verdict& v) {
  std::string text;
  for (const Unmeasured& u : v.unmeasured) {
    text += "\nnot measurable: " + shortened(u.check.name, widest_line - 16) + "\n";
    for (const std::string& part : wrapped(u.reason, widest_failure - 2)) text += "  " + part + "\n";
  }
  return text;
}

std::string diagnosis(const Verdict& v) {
  std::string text;
  for (const Finding& finding : v.diagnosis)
    for (const std::string& part : wrapped(finding.words, widest_failure - 2)) text += "  " + part + "\n";
  return text.empty() ? text : "\ndiagnosis\n" + text;
}

std::string conclusion(const Verdict& v) {
  const auto all = static_cast<std::int64_t>(v.checks.size()), failed = v.failed();
  if (failed > 0) return fmt::format("FAILED: {} of {} checks\n", failed, all);
  if (v.status != "done") return fmt::format("not finished ({}): {} of {} checks passed so far\n", v.status, all, all);
  if (const std::size_t untold = v.unmeasured.size(); untold > 0)
    return fmt::format("not measurable: {} of {} checks; the others passed\n", untold, v.checks.size() + untold);
  if (all == 0)
    return v.measured.empty() ? "FAILED: there was nothing to check\n"
                              : "measured; nothing that is promised was checked\n";
  return fmt::format("passed: {} of {} checks\n", all, all);
}

}  // namespace

std::string verdict_report(const Subject& subject, const Scene& scene, const Verdict& v) {
  const char* how_to_read =
      "\n  Each sum is zero in theory: `largest` is the worst, over the sum of its absolute terms, 1e-16 being "
      "rounding; a check\n"
      "  passes below its tolerance, or fails and says why. What is measured below is not promised to vanish.\n";
  return header(subject, scene, v) + how_to_read + table_of_checks(v) + table_of_measured(v) + left_out(v) +
         failures(v) + unmeasured(v) + diagnosis(v) + "\n" + conclusion(v);
}

}  // namespace delf
