// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "tools/report/in_words.hpp"
#include "tools/report/step_clock.hpp"
#include "tools/report/text_columns.hpp"
#include "tools/workprecision/workprecision_outcome.hpp"

namespace delf {

namespace {

constexpr std::size_t terminal = 110;

std::string number(const char* format, double value) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "";
}

// "1.2 ms", so that a column of them is easily compared
std::string milliseconds(double seconds) { return number("{:.3g}", 1e3 * seconds); }

// Runs one by one: of a short ladder all, else those of the envelopes.
std::string runs_table(const WorkPrecisionOutcome& o, bool all) {
  std::vector<std::vector<std::string>> rows;
  for (const WorkPrecisionRun& r : o.runs) {
    if (!all && !r.on_envelope) continue;
    rows.push_back(
        {r.scheme + (r.peer ? " (peer)" : ""), std::to_string(r.sites), number("{:.3g}", r.time_step / r.space_step),
         std::to_string(r.steps), number("{:.2e}", r.error_linf), number("{:.2e}", r.error_l2),
         number("{:.1e}", r.energy_error_max), number("{:.1e}", r.position_error), milliseconds(r.seconds),
         r.repeats == 0 ? "once" : fmt::format("{}-{}", milliseconds(r.seconds_min), milliseconds(r.seconds_max)),
         r.on_envelope ? "*" : ""});
  }
  return text_table({{"scheme", false, 28},
                     {"N", true},
                     {"h/k", true},
                     {"steps", true},
                     {"L∞", true},
                     {"L2", true},
                     {"energy", true},
                     {"position", true},
                     {"ms", true},
                     {"least-most", true},
                     {""}},
                    rows, terminal);
}

// The table by scheme: a row of cells for each, by the heads that follow.
std::vector<std::vector<std::string>> scheme_rows(const WorkPrecisionOutcome& o) {
  std::vector<std::vector<std::string>> rows;
  for (const WorkPrecisionLine& line : o.lines) {
    if (line.front.empty()) continue;
    const auto runs = std::ranges::count(o.runs, line.scheme, &WorkPrecisionRun::scheme);
    const WorkPrecisionRun& best = o.runs[line.front.back()];
    std::vector<std::string> row{line.scheme + (line.peer  ? " (peer)"
                                                : line.own ? " (scene's)"
                                                           : ""),
                                 std::to_string(runs), number("{:.2f}", line.order),
                                 number("{:.3g}", best.forces_per_step), number("{:.2f}", line.slope)};
    for (const double accuracy : {1e-2, 1e-4, 1e-6, 1e-8}) {
      const auto found = std::ranges::find_if(line.front, [&](auto i) { return o.runs[i].error_linf <= accuracy; });
      row.push_back(found == line.front.end() ? "" : milliseconds(o.runs[*found].seconds));
    }
    row.push_back(number("{:.2e}", best.error_linf));
    row.push_back(milliseconds(best.seconds));
    rows.push_back(row);
  }
  return rows;
}
std::vector<TextColumn> scheme_columns() {
  return {{"scheme", false, 32}, {"runs", true},       {"order", true}, {"forces", true},
          {"slope", true},       {"ms to 1e-2", true}, {"1e-4", true},  {"1e-6", true},
          {"1e-8", true},        {"least L∞", true},   {"in ms", true}};
}
std::string lines_table(const WorkPrecisionOutcome& o) {
  return text_table(scheme_columns(), scheme_rows(o), terminal);
}

constexpr auto what_columns_are =
    "order: of the error in N at one h/k; forces: evaluations at each site in a step; slope: of log error over log "
    "time; "
    "times of the steps alone, of the cheapest run with at most that error";

/// Names of schemes and peers that have a part in common, in words.
struct NamePart {
  const char *part, *shown, *meaning;
};
constexpr NamePart name_parts[] = {
    {"composition (", "composition (s,p)", "sub-steps of leapfrog, of order s in time; wide pairs of order p in space"},
    {"processed (", "processed (kernel,p)",
     "ti4 has one kick a step, with a force gradient, and b6 six; order p in space"},
    {" suited", "... suited", "central differences fitted to fields that are analytic in a strip, lattice.analyticity"},
    {"spacetime (", "spacetime (m,n)", "elements of degree m in time and n in space, with this quadrature"},
    {"cgvi ", "cgvi S R",
     "S functions on a step, R points of its quadrature; lumped or linear elements, or pairs, in space"},
    {"odeint ", "odeint NAME n, differences p",
     "a stepper of Boost.odeint, of order n, on central differences of order p"},
    {"Fourier split-step ", "Fourier split-step n", "a splitting of order n, derivatives by Fourier series"},
    {" (peer)", "(peer)", "another program or method, with the scene's equation"},
    {" (scene's)", "(scene's)", "the scheme that the scene itself names"}};

std::string what_names_are(const WorkPrecisionOutcome& o) {
  std::string text;
  for (const NamePart& part : name_parts) {
    const auto has = [&](const WorkPrecisionLine& line) {
      const std::string name = line.scheme + (line.peer ? " (peer)" : line.own ? " (scene's)" : "");
      return !line.front.empty() && name.find(part.part) != name.npos;
    };
    if (std::ranges::none_of(o.lines, has)) continue;
    const char* begin = "  ";
    for (const std::string& line : wrapped(fmt::format("{}: {}", part.shown, part.meaning), terminal - 6))
      text += fmt::format("{}{}\n", begin, line), begin = "      ";
  }
  return text;
}

/// Schemes that were left out, by the reason: a reason that several schemes share is said once, with their number.
std::string left_out_in_words(const WorkPrecisionOutcome& o) {
  std::vector<std::pair<std::string, std::vector<std::string>>> reasons;
  for (const auto& [scheme, reason] : o.left_out) {
    // "lattice.stencil = midpoint: is for mechanics" is the reason of several
    const std::size_t named = reason.find(" = " + scheme + ": ");
    const std::string shared = named == reason.npos ? reason : reason.substr(named + scheme.size() + 5);
    const auto known = std::ranges::find(reasons, shared, [](const auto& r) { return r.first; });
    if (known == reasons.end()) reasons.push_back({shared, {scheme}});
    else known->second.push_back(scheme);
  }
  std::string text;
  for (const auto& [reason, schemes] : reasons) {
    const char* begin = "  ";
    const std::string of = schemes.size() == 1 ? schemes.front() + ": " : fmt::format("{} schemes: ", schemes.size());
    for (const std::string& line : wrapped(of + reason, terminal - 4))
      text += fmt::format("{}{}\n", begin, line), begin = "    ";
    if (schemes.size() == 1) continue;
    for (const std::string& line : wrapped(fmt::format("{}", fmt::join(schemes, "; ")), terminal - 4))
      text += fmt::format("    {}\n", line);
  }
  return text;
}

std::string escaped(const std::string& text, std::string_view special) {
  std::string out;
  for (const char c : text) {
    if (special.find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

std::string costs_table(const WorkPrecisionOutcome& o) {
  std::vector<std::vector<std::string>> rows;
  const auto cells = [&](std::vector<std::string>& row, const std::optional<std::size_t>& index) {
    if (!index) return void(row.insert(row.end(), {"none gets there", "", "", ""}));
    const WorkPrecisionRun& r = o.runs[*index];
    row.insert(row.end(), {r.scheme, std::to_string(r.sites), number("{:.3g}", r.time_step / r.space_step),
                           milliseconds(r.seconds)});
  };
  const bool peers = std::ranges::any_of(o.runs, &WorkPrecisionRun::peer);
  for (const WorkPrecisionCost& cost : o.costs) {
    std::vector<std::string> row{fmt::format("{:.0e}", cost.accuracy)};
    cells(row, cost.engine);
    if (peers) {
      cells(row, cost.peer);
      row.push_back(number("{:.2f}", cost.ratio));
    }
    rows.push_back(row);
  }
  std::vector<TextColumn> columns{
      {"L∞ ≤", true}, {"cheapest scheme", false, 28}, {"N", true}, {"h/k", true}, {"ms", true}};
  if (peers)
    for (const TextColumn& column : std::vector<TextColumn>{
             {"cheapest peer", false, 24}, {"N", true}, {"h/k", true}, {"ms", true}, {"ratio", true}})
      columns.push_back(column);
  return text_table(columns, rows, terminal);
}

// Schemes that know the solution against the peers of the first table, and its engine against processed peers.
std::string special_costs_table(const WorkPrecisionOutcome& o) {
  std::vector<std::vector<std::string>> rows;
  const auto cells = [&](std::vector<std::string>& row, const std::optional<std::size_t>& index, double ratio) {
    if (!index) return void(row.insert(row.end(), {"none gets there", "", "", "", ""}));
    const WorkPrecisionRun& r = o.runs[*index];
    row.insert(row.end(), {r.scheme, std::to_string(r.sites), number("{:.3g}", r.time_step / r.space_step),
                           milliseconds(r.seconds), number("{:.2f}", ratio)});
  };
  for (const WorkPrecisionCost& cost : o.costs) {
    rows.push_back({fmt::format("{:.0e}", cost.accuracy)});
    cells(rows.back(), cost.tuned, cost.tuned_ratio);
    cells(rows.back(), cost.processed_peer, cost.processed_ratio);
  }
  return text_table({{"L∞ ≤", true},
                     {"cheapest suited scheme", false, 26},
                     {"N", true},
                     {"h/k", true},
                     {"ms", true},
                     {"ratio", true},
                     {"cheapest processed peer", false, 30},
                     {"N", true},
                     {"h/k", true},
                     {"ms", true},
                     {"ratio", true}},
                    rows, terminal);
}

}  // namespace

std::string workprecision_markdown(const Scene& scene, const WorkPrecisionRequest& request,
                                   const WorkPrecisionOutcome& o) {
  std::string text = fmt::format("{}: {} to t = {:.6g}, error against {}. {}.\n\n|", scene.name, scene.problem.theory,
                                 request.until, o.reference, what_columns_are);
  for (const TextColumn& column : scheme_columns()) text += fmt::format(" {} |", column.heading);
  text += "\n|";
  for (const TextColumn& column : scheme_columns()) text += column.right ? "---:|" : "---|";
  for (const auto& row : scheme_rows(o)) {
    text += "\n|";
    for (const std::string& cell : row) text += fmt::format(" {} |", escaped(cell, "|"));
  }
  return text + "\n";
}

std::string workprecision_latex(const Scene& scene, const WorkPrecisionRequest& request,
                                const WorkPrecisionOutcome& o) {
  constexpr auto special = "&%$#_{}";
  std::string text = fmt::format("% {}: {} to t = {:.6g}, error against {}\n% {}\n\\begin{{tabular}}{{", scene.name,
                                 scene.problem.theory, request.until, o.reference, what_columns_are);
  const auto row_of = [](const std::vector<std::string>& cells) {
    return fmt::format("{} \\\\\n", fmt::join(cells, " & "));
  };
  std::vector<std::string> heads;
  for (const TextColumn& column : scheme_columns()) {
    text += column.right ? 'r' : 'l';
    heads.push_back(column.heading == "least L∞" ? "least $L_\\infty$" : column.heading);
  }
  text += "}\n\\hline\n" + row_of(heads) + "\\hline\n";
  for (std::vector<std::string> row : scheme_rows(o)) {
    for (std::string& cell : row) cell = escaped(cell, special);
    text += row_of(row);
  }
  return text + "\\hline\n\\end{tabular}\n";
}

std::string workprecision_report(const Scene& scene, const WorkPrecisionRequest& request,
                                 const WorkPrecisionOutcome& o) {
  std::string text = fmt::format("{}: {} to t = {:.6g}, error against {}\n", scene.name, scene.problem.theory,
                                 request.until, o.reference);
  text += fmt::format(
      "  {} of {} resolutions tried are timed, {} times each{}, interleaved, in random order; median {} of the "
      "steps alone\n",
      o.runs.size(), o.tried, request.repeats, o.fewer_repeats ? ", the long ones less often" : "",
      time_of_steps(scene.problem.threads));
  if (o.unsteady > 0)
    text += fmt::format(
        "  warning: {} of these runs took three times as long in one round as in another, or more: something else used "
        "the\n"
        "  machine, and times and ratios are uncertain by that; repeat it on an idle one\n",
        o.unsteady);
  text +=
      "  A line is a run: errors of its last row, and the time of its steps. Take the line with the least time whose "
      "error is\n"
      "  small enough; a scheme is the better choice where its line stands in the table of accuracies below.\n";
  if (!o.runs.empty()) {
    constexpr std::size_t few = 40;
    const bool all = o.runs.size() <= few;
    text += fmt::format("\n{}\n{}",
                        all ? "runs (* no other is both cheaper and as accurate)"
                            : "runs on the lower envelopes (all of them are in workprecision.csv)",
                        runs_table(o, all));
    text += "\nschemes (nothing is interpolated)\n" + lines_table(o);
    for (const std::string& line : wrapped(what_columns_are, terminal - 2)) text += "  " + line + "\n";
    text += what_names_are(o);
    text +=
        "\nthe cheapest run with at most an error; ratio: time of the peer over that of the engine\n" + costs_table(o);
    if (std::ranges::any_of(o.runs, [](const WorkPrecisionRun& r) { return r.tuned || r.processed; }))
      text +=
          "\nschemes with pairs that suit the solution, and the peers above; processed peers, and the engine above\n" +
          special_costs_table(o);
  }
  if (!o.left_out.empty()) text += "\nleft out\n";
  text += left_out_in_words(o);
  if (o.reference_error > 0)
    text += fmt::format("\nerrors below {:.1e} are no better known than the reference\n", o.reference_error);
  if (o.status != "done") text += fmt::format("\nnot finished ({})\n", o.status);
  return text + fmt::format("\n{} in all\n", duration_in_words(o.seconds));
}

}  // namespace delf
