// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstddef>

#include "schemes/monodromy.hpp"
#include "tools/outcome/findings_json.hpp"
#include "tools/outcome/outcome.hpp"

namespace delf {

std::string summary_json(const Subject& subject, const Scene& scene, const Outcome& o) {
  const Problem& p = scene.problem;
  Json json = json_head(scene);
  json["status"] = o.status;
  json["failure"] = text_or_null(o.failure);
  const bool broken = !std::isnan(o.break_time);
  json["break_time"] = o.break_time;
  json["break_reason"] = broken ? Json(o.status) : Json();
  json["theory"] = p.theory;
  json["fibre"] = p.circle_valued ? "S1" : "R";
  json["stencil"] = subject.stencil;
  json["method"] = subject.method;
  json["space"] = subject.space;
  json["length"] = subject.length;
  json["sites"] = subject.sites;
  if (subject.cells) json["cells"] = *subject.cells;
  json["space_step"] = subject.space_step;
  json["time_step"] = subject.time_step;
  if (o.longest > 0) json["time_step_min"] = o.shortest, json["time_step_max"] = o.longest;
  json["winding"] = o.winding;
  json["boundary_gain"] = gain_of(p.parameters);
  json["state"] = o.state;
  json["start"] = std::isnan(subject.time_step) ? Json() : to_string(o.start);
  json["seed"] = scene.initial.seed;
  json["steps"] = o.steps;
  json["time"] = o.time;
  json["records"] = o.records;
  json["seconds"] = o.seconds;
  json["ns_per_site_step"] = o.ns_per_site_step(subject.sites);
  if (o.updates > 0) {
    json["updates"] = o.updates;
    json["ns_per_update"] = 1e9 * o.seconds / static_cast<double>(o.updates);
  }
  json["solve"] = o.solve;
  json["solve_kind"] = o.solve_kind;
  if (!o.limit.empty()) json["step_limit"] = o.limit;
  json["bytes"] = o.bytes;
  json["iterations_mean"] = o.iterations_mean;
  json["iterations_max"] = o.iterations_max;
  auto& continued = json["continued"] = Json::array();
  for (const auto& [why, steps] : o.continued) continued.push_back({{"steps", steps}, {"reason", in_words(why)}});
  json["residual_max"] = o.residual_max;
  json["energy_initial"] = o.energy_initial;
  json["energy_final"] = o.energy_final;
  json["energy_error_max"] = o.energy_error_max;
  json["energy_of"] = text_or_null(o.energy_of);
  json["energy_work"] = o.energy_work;
  json["maxima_over"] = text_or_null(o.maxima_over);
  json["momentum_initial"] = o.momentum_initial;
  json["momentum_final"] = o.momentum_final;
  json["charge_final"] = o.charge_final;
  json["constraint_max"] = o.constraint_max;
  const std::vector<Monitor>& monitors = find_method(p.method).monitors;
  for (std::size_t m = 0; m < monitors.size(); ++m)
    json[monitors[m].name] = m < o.of_method.size() ? o.of_method[m] : Outcome::unknown;
  auto& conserved = json["conserved"] = Json::array();
  for (const Conserved& c : o.conserved)
    conserved.push_back({{"name", c.name},
                         {"initial", c.initial},
                         {"final", c.final},
                         {"error_max", c.error_max},
                         {"at_walls", c.at_walls}});
  json["error_linf"] = o.error_linf;
  json["error_l2"] = o.error_l2;
  auto& measures = json["measures"] = Json::object();
  for (const NamedNumber& m : o.measures) measures[m.name] = m.value;
  if (o.error_estimate) {
    const ErrorEstimate& e = *o.error_estimate;
    auto& estimate = json["error_estimate"];
    estimate["failure"] = text_or_null(e.failure);
    const auto put = [](auto& into, const Richardson& r) {
      into["error"] = r.error;
      into["order"] = r.order;
      into["converging"] = r.converging;
    };
    put(estimate, e.row);
    auto& of_measures = estimate["measures"] = Json::object();
    for (const auto& [name, r] : e.measures) put(of_measures[name], r);
  }
  json["warnings"] = scene.warnings;
  for (const std::string& warning : o.warnings) json["warnings"].push_back(warning);
  return json_text(json);
}

}  // namespace delf
