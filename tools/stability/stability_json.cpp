// SPDX-License-Identifier: MIT
#include "tools/outcome/findings_json.hpp"
#include "tools/stability/stability_findings.hpp"

namespace delf {

namespace {

Json json_of(const GhostMode& g) {
  return {{"theta", g.theta},
          {"z", {g.z.real(), g.z.imag()}},
          {"what", g.words}};
}

Json json_of(const Limit& l) {
  Json ghosts = Json::array(), stable = Json::array(), probes = Json::array(), unresolved = Json::array();
  for (const GhostMode& g : l.symbol.ghosts) ghosts.push_back(json_of(g));
  for (const CourantInterval& i : l.symbol.stable) stable.push_back({i.from, i.to});
  for (const Probe& p : l.probes)
    probes.push_back({{"courant", p.courant},
                      {"theory", p.theory_stable ? "stable" : "unstable"},
                      {"observed", to_string(p.observed)},
                      {"sites", p.sites},
                      {"steps", p.steps},
                      {"growth_theory", p.growth},
                      {"resolved", p.resolved}});
  for (const Unresolved& u : l.unresolved)
    unresolved.push_back({{"courant", u.courant},
                          {"theta", u.theta},
                          {"growth_theory", u.growth},
                          {"sites", u.sites},
                          {"steps_needed", u.steps}});
  return {{"scheme", l.scheme},
          {"waves", l.waves},
          {"mass_step", l.mass_step ? Json(*l.mass_step) : Json()},
          {"courant_theory", l.theory},
          {"courant_observed", l.observed},
          {"agrees", l.left_out.empty() && !(l.agrees() && l.limit_unresolved) ? Json(l.agrees()) : Json()},
          {"left_out", text_or_null(l.left_out)},
          {"stable_courants", stable},
          {"ghosts", ghosts},
          {"observed_even", l.even ? Json(to_string(*l.even)) : Json()},
          {"observed_odd", l.odd ? Json(to_string(*l.odd)) : Json()},
          {"probes", probes},
          {"unresolved", unresolved},
          {"disagreements", l.disagreements}};
}

Json json_of(const ConstraintFinding& c) { return {{"scheme", c.scheme}, {"what", c.words}}; }

Json json_of(const StressFinding& f) {
  Json parameters = Json::object();
  for (const Setting& key : keys_of(f.stress_case)) parameters[key.key] = key.value;
  const StressResult& r = f.result;
  return {{"name", f.stress_case.name},
          {"group", f.stress_case.group},
          {"scheme", f.stress_case.scheme},
          {"parameters", parameters},
          {"verdict", to_string(r.verdict)},
          {"reason", text_or_null(r.reason)},
          {"error_linf", r.error_linf},
          {"energy_error_max", r.energy_error_max},
          {"residual_max", r.residual_max},
          {"diverged_at", r.diverged_at},
          {"cut_at", r.cut_at},
          {"steps", r.steps},
          {"seconds", r.seconds}};
}

Json json_of(const StabilityMap& m) {
  Json rows = Json::array(), edges = Json::array();
  for (std::size_t j = 0; j < m.mass_steps.size(); ++j) {
    Json row = Json::array();
    for (std::size_t i = 0; i < m.courants.size(); ++i) row.push_back(to_string(m.grows[j * m.courants.size() + i]));
    rows.push_back(row);
  }
  for (std::size_t j = 0; j < m.edge_masses.size(); ++j)
    for (const double courant : m.edges[j]) edges.push_back({m.edge_masses[j], courant});
  return {{"scheme", m.scheme},
          {"sites", m.sites},
          {"courants", m.courants},
          {"mass_steps", m.mass_steps},
          {"observed", rows},
          {"theory_edges", edges}};
}

Json json_of(const DispersionCurve& c) {
  Json points = Json::array();
  for (const FrequencyPoint& p : c.points)
    points.push_back({p.wave_number, p.numerical, p.exact});
  return {{"scheme", c.scheme}, {"qk_omegak_exact", points}};
}

constexpr auto of_each = [](const auto& one) { return json_of(one); };

}  // namespace

std::string stability_json(const Scene& scene, const StabilityFindings& f) {
  Json json = json_head(scene);
  json["status"] = f.status;
  json["passed"] = f.passed();
  json["seconds"] = f.seconds;
  json["seed"] = f.seed;
  json["limits_theory"] = "klein-gordon";
  json["courant_most"] = f.most_courant;
  json["agreement"] = f.agreement;
  json["growth_least"] = f.least_growth;
  json["unresolved"] = f.unresolved();
  json["own_scheme_left_out"] = text_or_null(f.own_left_out);
  json["limits"] = json_list(f.limits, of_each);
  json["constraint_ghosts"] = json_list(f.constraints, of_each);
  json["corners"] = json_list(f.stress_cases, of_each);
  json["maps"] = json_list(f.maps, of_each);
  json["dispersion"] = {{"courant", f.dispersion_courant},
                        {"mass_space_step", f.dispersion_mass},
                        {"curves", json_list(f.dispersion, of_each)}};
  return json_text(json);
}

}  // namespace delf
