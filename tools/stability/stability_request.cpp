// SPDX-License-Identifier: MIT
#include "tools/stability/stability_request.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "jets/tables/named_tables.hpp"
#include "schemes/stability/highest_frequency.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "schemes/unknown_name.hpp"
#include "tools/scene/lists.hpp"
#include "tools/scene/suggestion.hpp"
#include "tools/scene/values.hpp"
#include "tools/stability/stress_cases.hpp"
#include "tools/warnings/vacuum_symbol.hpp"

namespace delf {

namespace {

bool has_own_waves(const Scene& scene, const BatchDensity& density) {
  if (scene.settings.find("stability.waves")) return Values(scene.settings).choice("stability.waves") == "own";
  return density.slots() > 3;
}

/// h/k at which the highest frequency ω that the lattice has makes ωh = 2, as leapfrog's limit does: 1/c for waves of
/// speed c.
double own_courant_unit(const BatchDensity& density, double k) {
  if (density.is_placed()) return 1;
  const double omega = highest_frequency(density, 0, 2 / k);
  return omega > 0 ? 2 / (omega * k) : 1;
}

/// The scene's own scheme, and others that are asked for.
std::vector<NamedScheme> with_own_scheme(const std::vector<std::string>& asked, const Problem& base) {
  std::vector<NamedScheme> schemes;
  if (!asked.empty()) schemes = chosen_schemes(asked, base);
  const std::string own = scheme_label(base);
  if (std::ranges::find(schemes, own, &NamedScheme::name) == schemes.end())
    schemes.insert(schemes.begin(), {own, base});
  return schemes;
}

bool same_scheme(const Problem& a, const Problem& b) {
  const Problem x = completed(a), y = completed(b);
  return x.method == y.method && x.stencil == y.stencil && std::ranges::equal(x.parameters, y.parameters);
}

/// The scene's own scheme is among those of klein-gordon, or words say why it is not.
void add_own_scheme(StabilityRequest& request, const Problem& base) {
  if (std::ranges::any_of(request.schemes, [&](const NamedScheme& s) { return same_scheme(s.problem, base); })) return;
  const std::string own = scheme_label(base);
  try {
    Simulation(LinearWaves{base, 1}.on_circle(0.5, 32));  // of sites that bricks close on
    add_once(request.schemes, {own, base});
  } catch (const BadInput& refused) {
    const std::string reason = refused.what();  // "what is wrong; a remedy", which would be one for a circle
    request.own_left_out =
        fmt::format("not applicable to the scene's own scheme ({}): limits are of waves on a circle; {}", own,
                    reason.substr(0, reason.rfind("; ")));
  }
}

}  // namespace

void add_once(std::vector<NamedScheme>& schemes, const NamedScheme& scheme) {
  if (std::ranges::find(schemes, scheme.name, &NamedScheme::name) == schemes.end()) schemes.push_back(scheme);
}

std::vector<std::string> listed_names(const Scene& scene, const char* key) {
  const auto text = Values(scene.settings).text(key);
  std::vector<std::string> names = names_in(text.value_or(""));
  if (text && names.empty()) throw scene.settings.error(key, "names nothing; write what you mean, separated by commas");
  return names;
}

std::vector<NamedScheme> chosen_schemes(const std::vector<std::string>& asked, const Problem& base) {
  const std::vector<NamedScheme> all = named_schemes(base);
  if (asked.size() == 1 && asked.front() == "all") return all;
  // one of each sort: explicit, implicit, from no Lagrangian, with nodes inside
  static const std::vector<std::string> usual{
      "triangle-vertex", "rectangle-symmetric", "rectangle", "hexagon",
      "triangle",        "vu-quoc-li",          "guo",       "spacetime (2,2) gauss"};
  std::vector<NamedScheme> chosen;
  for (const std::string& given : asked.empty() ? usual : asked) {
    const std::string name = stencil_name(given, base.lattice.space() == Space::point);
    const auto scheme = std::ranges::find(all, name, &NamedScheme::name);
    if (scheme != all.end()) {
      add_once(chosen, *scheme);
      continue;
    }
    std::vector<std::string> names = stencil_names_and_aliases();
    names.emplace_back("all");
    for (const NamedScheme& s : all) names.push_back(s.name);
    throw unknown_name("stability.schemes", name, names);
  }
  return chosen;
}

StabilityRequest read_stability_request(const Scene& scene) {
  const Values values(scene.settings);
  const auto list = [&](const char* key) { return listed_names(scene, key); };
  StabilityRequest request;
  double own_unit = 1;
  try {
    const auto theory = make_theory(find_theory(scene.problem.theory), scene.problem.parameters);
    request.own_waves = has_own_waves(scene, theory->density());
    if (request.own_waves && !theory->density().is_placed() && !zero_is_a_solution(theory->density()))
      throw scene.settings.error("stability.waves",
                                 "own waves are those about the field 0, which does not solve the field equations of "
                                 "this theory; use stability.waves = klein-gordon");
    if (request.own_waves) own_unit = own_courant_unit(theory->density(), scene.problem.lattice.space_step());
    request.schemes = request.own_waves ? with_own_scheme(list("stability.schemes"), scene.problem)
                                        : chosen_schemes(list("stability.schemes"), scene.problem);
    if (!request.own_waves && list("stability.schemes").empty()) add_own_scheme(request, scene.problem);
  } catch (const BadInput& bad) {
    throw scene.settings.located(bad);
  }
  if (const auto masses = positive_numbers(scene.settings, "stability.mass_steps"); !masses.empty())
    request.mass_steps = masses;
  request.stress_cases = list("stability.corners");
  for (const std::string& group : request.stress_cases)
    if (group != "none" && std::ranges::find(stress_groups(), group) == stress_groups().end())
      throw scene.settings.error("stability.corners", fmt::format("{} is no group of stress cases{}", group,
                                                                  suggestion(group, stress_groups())));
  if (request.stress_cases.empty()) request.stress_cases = stress_groups();
  std::erase(request.stress_cases, "none");
  request.limit.most = values.real("stability.most_courant");
  request.limit.steps = static_cast<int>(values.integer("stability.steps"));
  request.limit.agreement = values.real("stability.agreement");
  request.limit.seed = scene.initial.seed;
  if (values.choice("stability.fault") == "limit") request.limit.theory_factor = 1.05;
  request.budget = values.real("stability.budget");
  request.map = values.toggle("stability.map");
  if (request.own_waves) request.stress_cases.clear(), request.map = false, request.limit.most *= own_unit;
  return request;
}

}  // namespace delf
