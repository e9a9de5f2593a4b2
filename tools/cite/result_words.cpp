// SPDX-License-Identifier: MIT
#include "tools/cite/result_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ranges>
#include <regex>
#include <set>

#include "tools/peers/body_peers.hpp"
#include "tools/peers/peer.hpp"
#include "tools/report/machine.hpp"
#include "tools/results/same_scene.hpp"

namespace delf {
namespace {

std::string with_blanks(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

/// "FILE:LINE: key: …" without the place, which is one of the machine.
std::string without_place(const std::string& words) {
  static const std::regex place("^.*?\\.ini:[0-9]+: |^\\S+:[0-9]+: ");
  return std::regex_replace(words, place, "", std::regex_constants::format_first_only);
}

void say_run(PaperText& text, const Json& run) {
  const std::string status = text_in(&run, "status");
  const auto steps = number_in(&run, "steps");
  const auto time = number_in(&run, "time");
  if (status != "done")
    text.say(
        fmt::format("The run ended early, at {}: {}.", equal_in_paper("t", time.value_or(0)),
                    text_in(&run, "failure").empty() ? "it was " + status : without_place(text_in(&run, "failure"))));
  std::vector<std::string> found;
  if (const auto error = number_in(&run, "energy_error_max"); error && steps.value_or(0) > 0)
    found.push_back(fmt::format("a relative error of the energy of at most {}", error_in_paper(*error)));
  for (const Json& conserved : list_in(&run, "conserved"))
    if (const auto error = number_in(&conserved, "error_max"); error && !is_true_in(&conserved, "at_walls"))
      found.push_back(fmt::format("of the {} of {}", with_blanks(text_in(&conserved, "name")), error_in_paper(*error)));
  if (const auto constraint = number_in(&run, "constraint_max"))
    found.push_back(fmt::format("constraints that hold to {}", error_in_paper(*constraint)));
  if (const auto residual = number_in(&run, "residual_max"))
    found.push_back(fmt::format("a residual of at most {} of the terms of the equations", error_in_paper(*residual)));
  if (const auto error = number_in(&run, "error_linf"))
    found.push_back(
        time && *time > 0
            ? fmt::format("an error of {} against the exact solution at {}, in the maximum norm",
                          error_in_paper(*error), equal_in_paper("t", *time))
            : fmt::format("an error of {} against the exact solution, in the maximum norm", error_in_paper(*error)));
  if (!found.empty()) text.say(fmt::format("The run shows {}.", listed(found)));
  if (const auto warnings = texts_in(&run, "warnings"); !warnings.empty())
    text.say(fmt::format("It ended with {}: {}.", warnings.size() == 1 ? "a warning" : "warnings",
                         fmt::join(warnings | std::views::transform(without_place), "; ")));
}

void say_verification(PaperText& text, const ResultFolder& folder, const Json& verify) {
  if (!other_scene(folder).empty()) return;  // it says nothing of these rows
  struct Group {
    const char *begins, *words, *several;  ///< of that name
  };
  static constexpr Group groups[] = {
      {"field equations", "the field equations", ""},
      {"constraints", "the constraints", ""},
      {"form formula", "the discrete multisymplectic form formula", " on {} kinds of regions"},
      {"local identity", "its local identity", ""},
      {"symplectic form", "the conservation of the symplectic form", ""},
      {"Noether", "the discrete Noether theorem", " for {} symmetries"},
      {"time reversal", "time reversal", ""}};
  const std::vector<Json> checks = list_in(&verify, "checks");
  std::vector<std::string> failed, held;
  std::set<std::string> regions;
  for (const Json& check : checks)
    if (!is_true_in(&check, "passed")) failed.push_back(text_in(&check, "name"));
  for (const Group& group : groups) {
    double worst = -1;
    int kinds = 0;
    for (const Json& check : checks)
      if (text_in(&check, "name").starts_with(group.begins) && is_true_in(&check, "passed"))
        worst = std::max(worst, number_in(&check, "value").value_or(0)), ++kinds;
    if (worst >= 0)
      held.push_back(fmt::format("{}{} to {}", group.words,
                                 kinds > 1 ? fmt::format(fmt::runtime(group.several), kinds) : "",
                                 error_in_paper(worst)));
  }
  const std::string sums = "relative to the sum of the absolute values of their terms";
  if (failed.empty())
    text.say(fmt::format("All {} checks of `delf verify` passed{}{}.", checks.size(),
                         held.empty() ? "" : ", among them " + listed(held), held.empty() ? "" : ", " + sums));
  else
    text.say(fmt::format("{} of {} checks of `delf verify` failed: {}.{}", failed.size(), checks.size(),
                         fmt::join(failed, "; "),  // their names have commas
                         held.empty() ? "" : " Those that passed include " + listed(held) + ", " + sums + "."));
}

void say_convergence(PaperText& text, const Json& convergence) {
  const std::vector<Json> levels = list_in(&convergence, "levels");
  if (levels.empty()) return;
  const auto first = number_in(&levels.front(), "error_linf"), last = number_in(&levels.back(), "error_linf");
  const auto order = number_in(&convergence, "order");
  const std::string kind = text_in(&convergence, "error");
  std::string words = fmt::format("On {} levels of steps, each half of those before, the error{}", levels.size(),
                                  kind == "exact" ? " against the exact solution"
                                  : kind.empty()  ? ""
                                                  : " (" + kind + ")");
  if (first && last)
    words += fmt::format(" in the maximum norm is {} to {}", error_in_paper(*first), error_in_paper(*last));
  else words += " was measured";
  if (order) words += fmt::format(", and falls with order {}", number_in_paper(*order, 3));
  if (const auto expected = number_in(&convergence, "order_of_scheme"))
    words += fmt::format(" (the scheme's is {})", number_text(expected));
  text.say(words + (is_true_in(&convergence, "passed") ? "." : "; the check of the order did not pass."));
}

void say_stability(PaperText& text, const Json& stability) {
  std::set<std::string> schemes;
  std::size_t agree = 0;
  const std::vector<Json> limits = list_in(&stability, stability.contains("limits") ? "limits" : "point_limits");
  for (const Json& limit : limits) {
    schemes.insert(text_in(&limit, "scheme"));
    agree += is_true_in(&limit, "agrees") ? 1 : 0;
  }
  if (limits.empty()) return;
  text.say(fmt::format(
      "Limits of the step were found by linear theory and by runs from noise for {} scheme{}; {} of {} agree.",
      schemes.size(), schemes.size() == 1 ? "" : "s", agree, limits.size()));
}

void say_sweep(PaperText& text, const Json& sweep) {
  const std::vector<Json> runs = list_in(&sweep, "runs");
  std::vector<std::string> varied;
  for (const std::string& key : texts_in(&sweep, "keys")) {
    std::vector<std::string> values;
    for (const Json& run : runs)
      if (const auto settings = run.find("settings"); settings != run.end())
        if (const std::string value = text_in(&*settings, key);
            !value.empty() && std::ranges::find(values, value) == values.end())
          values.push_back(value);
    constexpr std::size_t most = 6;
    varied.push_back(values.size() <= most ? fmt::format("`{}` over {}", key, listed(values))
                                           : fmt::format("`{}` over {} values from {} to {}", key, values.size(),
                                                         values.front(), values.back()));
  }
  if (varied.empty()) return;
  const auto done = std::ranges::count_if(runs, [](const Json& run) { return text_in(&run, "status") == "done"; });
  text.say(fmt::format(
      "The study varied {}: {} runs, of which {} ended well. What is said above holds for the first of them.",
      listed(varied), runs.size(), done));
}

/// The peers of a comparison, with their sources.
void say_peers(PaperText& text, const Json& comparison) {
  std::vector<std::string> sources;
  int count = 0;
  std::set<std::string> named;
  for (const Json& run : list_in(&comparison, "schemes"))
    if (is_true_in(&run, "peer")) named.insert(text_in(&run, "scheme"));
  const auto take = [&](const auto& infos) {
    for (const auto& info : infos)
      if (std::ranges::any_of(named, [&](const std::string& name) { return name.find(info.name) != name.npos; })) {
        ++count;
        for (const std::string& key : info.sources)
          if (std::ranges::find(sources, key) == sources.end()) sources.push_back(key);
      }
  };
  take(peers::peers());
  for (const char* theory : {"pendulum", "kepler"}) take(peers::body_peers(theory));
  text.say(fmt::format(
      "Error against run time was measured for {} schemes{}.", list_in(&comparison, "schemes").size(),
      count == 0 ? "" : fmt::format(", integrators of other libraries among them{}", citation_of(sources))));
}

}  // namespace

void say_results(PaperText& text, const ResultFolder& folder) {
  if (const Json* run = folder.result("summary")) say_run(text, *run);
  if (const Json* verify = folder.result("verify")) say_verification(text, folder, *verify);
  if (const Json* convergence = folder.result("convergence")) say_convergence(text, *convergence);
  if (const Json* stability = folder.result("stability")) say_stability(text, *stability);
  if (const Json* sweep = folder.result("sweep")) say_sweep(text, *sweep);
  if (const Json* comparison = folder.result("workprecision")) say_peers(text, *comparison);
}

void say_program(PaperText& text, const ResultFolder* folder, bool stores_rows) {
  std::string version = DELF_VERSION, machine = machine_in_words(), compiler = compiler_in_words();
  if (folder)
    for (const std::string& kind : ResultFolder::kinds())
      if (const Json* result = folder->result(kind)) {
        version = text_in(result, "version"), machine = text_in(result, "machine"),
        compiler = text_in(result, "compiler");
        break;
      }
  if (const std::size_t flags = compiler.find(", -"); flags != compiler.npos) compiler.replace(flags, 1, " with");
  text.say(fmt::format("{} made with delf {} [@delf], compiled by {}, on {}{}.",
                       folder ? "The computation was" : "Computations are", version, compiler, machine,
                       stores_rows ? "; rows are stored by HDF5 [@hdf5]" : ""));
}

}  // namespace delf
