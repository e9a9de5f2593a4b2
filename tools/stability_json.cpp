// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/stability_findings.hpp"

namespace delf {

namespace {

using Json = nlohmann::ordered_json;

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(); }
Json text(const std::string& t) { return t.empty() ? Json() : Json(t); }

Json json_of(const GhostMode& g) {
  return {{"theta", number(g.theta)}, {"z", {number(g.z.real()), number(g.z.imag())}}, {"what", g.words}};
}

Json json_of(const Limit& l) {
  Json ghosts = Json::array(), stable = Json::array(), probes = Json::array();
  for (const GhostMode& g : l.symbol.ghosts) ghosts.push_back(json_of(g));
  for (const CourantInterval& i : l.symbol.stable) stable.push_back({number(i.from), number(i.to)});
  for (const Probe& p : l.probes)
    probes.push_back({{"courant", p.courant},
                      {"theory", p.theory_stable ? "stable" : "unstable"},
                      {"observed", to_string(p.observed)}});
  return {{"scheme", l.scheme},
          {"mass_step", l.mass_step},
          {"courant_theory", number(l.theory)},
          {"courant_observed", number(l.observed)},
          {"agrees", l.left_out.empty() ? Json(l.agrees()) : Json()},
          {"left_out", text(l.left_out)},
          {"stable_courants", stable},
          {"ghosts", ghosts},
          {"observed_even", l.even ? Json(to_string(*l.even)) : Json()},
          {"observed_odd", l.odd ? Json(to_string(*l.odd)) : Json()},
          {"probes", probes},
          {"disagreements", l.disagreements}};
}

Json json_of(const CornerFinding& f) {
  Json parameters = Json::object();
  for (const Setting& key : keys_of(f.corner)) parameters[key.key] = key.value;
  const CornerResult& r = f.result;
  return {{"name", f.corner.name},
          {"group", f.corner.group},
          {"scheme", f.corner.scheme},
          {"parameters", parameters},
          {"verdict", to_string(r.verdict)},
          {"reason", text(r.reason)},
          {"error_linf", number(r.error_linf)},
          {"energy_error_max", number(r.energy_error_max)},
          {"residual_max", number(r.residual_max)},
          {"diverged_at", number(r.diverged_at)},
          {"cut_at", number(r.cut_at)},
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
          {"courants", m.courants},
          {"mass_steps", m.mass_steps},
          {"observed", rows},
          {"theory_edges", edges}};
}

Json json_of(const DispersionCurve& c) {
  Json points = Json::array();
  for (const FrequencyPoint& p : c.points)
    points.push_back({number(p.wave_number), number(p.numerical), number(p.exact)});
  return {{"scheme", c.scheme}, {"qk_omegak_exact", points}};
}

template <class List>
Json list_of(const List& all) {
  Json list = Json::array();
  for (const auto& one : all) list.push_back(json_of(one));
  return list;
}

}  // namespace

std::string stability_json(const Scene& scene, const StabilityFindings& f) {
  Json json;
  json["version"] = DELF_VERSION;
  json["scene"] = scene.name;
  json["status"] = f.status;
  json["passed"] = f.passed();
  json["seconds"] = f.seconds;
  json["seed"] = f.seed;
  json["limits_theory"] = "klein-gordon";
  json["courant_most"] = f.most_courant;
  json["agreement"] = f.agreement;
  json["limits"] = list_of(f.limits);
  json["corners"] = list_of(f.corners);
  json["maps"] = list_of(f.maps);
  json["dispersion"] = {{"courant", number(f.dispersion_courant)},
                        {"mass_space_step", number(f.dispersion_mass)},
                        {"curves", list_of(f.dispersion)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace delf
