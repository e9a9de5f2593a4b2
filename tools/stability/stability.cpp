// SPDX-License-Identifier: MIT
#include "tools/stability/stability.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>

#include "lattice/error.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/stability/constraint_ghost.hpp"
#include "schemes/stepping/evolution.hpp"
#include "tools/figures/drawing.hpp"
#include "tools/files/text_file.hpp"
#include "tools/report/in_words.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/progress.hpp"
#include "tools/report/seconds_since.hpp"
#include "tools/stability/point_limits.hpp"
#include "tools/stability/stability_figures.hpp"
#include "tools/stability/stability_map.hpp"
#include "tools/stability/stress_cases.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

// Limits are those of a field without constraint; the scene's own theory may have one. Empty: it has none, or no such
// wave grows.
std::string growth_under_constraint(Problem problem) {
  constexpr int sites = 32;  // of a circle that is only asked for its equations
  problem.lattice = Lattice::circle(sites, sites * problem.lattice.space_step());
  problem.winding = 0, problem.parameters[gain_key] = 0.0;
  try {
    const auto ghost = ghost_under_constraint(Simulation(problem).evolution().system());
    return ghost ? in_words_under_constraint(*ghost) : "";
  } catch (const BadInput&) {  // the scheme is not for this theory
    return {};
  }
}

/// Says on stderr what is to be done and how long that takes on a machine that does nothing else.
void announce(std::int64_t limits, std::int64_t maps, std::size_t stress_cases, std::int64_t parts) {
  constexpr double seconds = 0.2, worth_saying = 5;  // of a part
  const double all = seconds * static_cast<double>(parts);
  if (Progress::silent || all < worth_saying) return;
  std::fputs(fmt::format("{} limits, {} maps and {} stress cases, about {}; fewer: stability.schemes, "
                         "stability.map=off, stability.corners=none\n",
                         limits, maps, stress_cases, duration_in_words(all))
                 .c_str(),
             stderr);
}

}  // namespace

StabilityFindings find_stability(const StabilityRequest& request, const Problem& base) {
  const auto begin = std::chrono::steady_clock::now();
  StabilityFindings f;
  f.own_waves = request.own_waves;
  f.own_left_out = request.own_left_out;
  f.most_courant = request.limit.most;
  f.agreement = request.limit.agreement;
  f.least_growth = request.limit.least_growth();
  f.limit_sites = request.limit.sites;
  f.seed = request.limit.seed;
  f.dispersion_courant = base.time_step / base.lattice.space_step();
  f.dispersion_mass = mass_of(base) * base.lattice.space_step();

  std::vector<StressCase> all;
  for (const std::string& group : request.stress_cases)
    for (StressCase& stress_case : stress_cases(group, request.schemes)) {
      stress_case.state.seed = request.limit.seed;
      all.push_back(std::move(stress_case));
    }
  std::vector<std::optional<double>> mass_steps(request.mass_steps.begin(), request.mass_steps.end());
  if (request.own_waves) mass_steps = {std::nullopt};
  const auto schemes = static_cast<std::int64_t>(request.schemes.size());
  constexpr std::int64_t map_parts = 8;  // a map takes as long as so many limits
  const std::int64_t limits = schemes * static_cast<std::int64_t>(mass_steps.size()), maps = request.map ? schemes : 0,
                     in_all = limits + maps * map_parts + static_cast<std::int64_t>(all.size());
  announce(limits, maps, all.size(), in_all);
  Progress progress(in_all, "part");
  std::int64_t done = 0;
  const auto advance = [&](std::int64_t parts) { progress.at(done += parts); };

  for (const NamedScheme& scheme : request.schemes)
    for (const auto mass_step : mass_steps) {
      if (Interrupt::asked()) break;
      f.limits.push_back(find_limit(scheme.name, {scheme.problem, mass_step}, request.limit));
      advance(1);
    }
  for (const NamedScheme& scheme : request.schemes) {
    if (Interrupt::asked() || request.own_waves) break;
    try {
      f.dispersion.push_back(make_dispersion_curve(scheme));
    } catch (const BadInput&) {  // reported with the limits
    }
    if (!request.map) continue;
    f.maps.push_back(make_stability_map(scheme, request.limit.most, request.limit.seed));
    advance(map_parts);
  }
  for (const NamedScheme& scheme : request.schemes)
    if (auto words = growth_under_constraint(scheme.problem); !words.empty())
      f.constraints.push_back({scheme.name, std::move(words)});
  for (StressCase& stress_case : all) {
    if (Interrupt::asked()) break;
    StressResult result = run_stress_case_apart(stress_case, request.budget);
    if (Interrupt::asked()) break;  // its verdict is that of an interrupted run
    f.stress_cases.push_back({std::move(stress_case), std::move(result)});
    advance(1);
  }
  if (Interrupt::asked()) f.status = "interrupted";
  f.seconds = seconds_since(begin);
  return f;
}

ExitCode stability(const Scene& scene, const fs::path& folder) {
  if (scene.problem.lattice.space() == Space::point) return point_stability(scene, folder);
  if (scene.problem.step_control)
    throw scene.settings.error("lattice.time_steps", "limits are of equal steps; leave it out");
  const Interrupt interrupt;
  const StabilityRequest request = read_stability_request(scene);
  const StabilityFindings findings = find_stability(request, scene.problem);
  if (findings.not_applicable())
    throw scene.settings.error(request.own_waves ? "stability.waves" : "stability.schemes",
                               "not applicable, there is no limit to find: " + findings.why_left_out());
  make_results_folder(folder);  // earlier results stay until there are new ones
  write_text_file(folder / "stability.json", stability_json(scene, findings));
  remove_figures(stability_figure_names(findings.maps.size() + maps_in_a_figure), folder);
  const bool draws = scene.figures && !request.own_waves;
  const std::string missing = draws ? draw_stability(findings, scene.name, scene.figure_form, folder) : std::string();
  fmt::print("{}", stability_report(scene, findings));
  fmt::print("{}: stability.json{}\n", folder.string(), draws && missing.empty() ? " figures" : "");
  if (!missing.empty()) fmt::print(stderr, "delf: no figures: {}\n", missing);
  if (findings.status == "interrupted") return ExitCode::interrupted;
  return findings.passed() ? ExitCode::done : ExitCode::check_failed;
}

}  // namespace delf
