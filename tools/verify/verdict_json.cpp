// SPDX-License-Identifier: MIT
#include <algorithm>
#include <functional>

#include "tools/outcome/findings_json.hpp"
#include "tools/verify/verdict.hpp"

namespace delf {

namespace {

Json json_of(const Check& c) {
  return {{"name", c.name},           {"region", c.region},         {"value", c.value},
          {"tolerance", c.tolerance}, {"normaliser", c.normaliser}, {"count", c.count},
          {"samples", c.samples},     {"passed", c.passed()},       {"failure", c.passed() ? Json() : Json(c.failure)},
          {"unmeasurable", Json()}};
}

Json json_of(const Unmeasured& u) {
  Json json = json_of(u.check);
  json["passed"] = false, json["failure"] = Json(), json["unmeasurable"] = u.reason;
  return json;
}

Json json_of(const Measured& m) {
  return {{"name", m.name},
          {"region", m.region},
          {"value", m.value},
          {"normaliser", m.normaliser},
          {"count", m.count},
          {"order", m.order},
          {"remark", text_or_null(m.remark)}};
}

Json json_of(const Finding& f) { return {{"kind", f.kind}, {"words", f.words}}; }

Json json_of(const RegionPoint& p) {
  return {
      {"kind", p.kind}, {"stencils", p.stencils}, {"value", p.value}, {"variations", p.local ? "local" : "evolved"}};
}

Json json_of(const SiteSeverity& s) {
  return {{"site", s.site},   {"field", s.field}, {"row", s.row},
          {"error", s.error}, {"force", s.force}, {"share", s.share()}};
}

// The worst of them; severity.csv has all.
std::vector<SiteSeverity> worst_of(std::vector<SiteSeverity> sites) {
  constexpr std::size_t most = 8;
  std::ranges::stable_sort(sites, std::greater{}, &SiteSeverity::share);
  std::erase_if(sites, [](const SiteSeverity& s) { return s.share() == 0; });
  if (sites.size() > most) sites.erase(sites.begin() + most, sites.end());
  return sites;
}

constexpr auto of_each = [](const auto& one) { return json_of(one); };

}  // namespace

std::string verdict_json(const Subject& subject, const Scene& scene, const Verdict& v) {
  const Problem& p = scene.problem;
  Json json = json_head(scene);
  json["theory"] = p.theory;
  json["stencil"] = subject.stencil;
  json["method"] = p.method;
  json["sites"] = subject.sites;
  json["time_step"] = p.time_step;
  json["seed"] = v.seed;
  json["subject"] = v.subject;
  json["status"] = v.status;
  json["seconds"] = v.seconds;
  json["stencils"] = v.stencils;
  json["passed"] = v.passed();
  json["checks"] = json_list(v.checks, of_each);
  for (const Unmeasured& u : v.unmeasured) json["checks"].push_back(json_of(u));
  json["measured"] = json_list(v.measured, of_each);
  json["diagnosis"] = json_list(v.diagnosis, of_each);
  json["severity"] = json_list(worst_of(v.severest), of_each);
  const EnergyHistory& energy = v.energy;
  json["energy_own"] = energy.value.empty() ? Json()
                                            : Json{{"name", energy.name},
                                                   {"meaning", energy.meaning},
                                                   {"first", energy.value.front()},
                                                   {"last", energy.value.back()}};
  json["left_out"] = v.left_out;
  json["regions"] = json_list(v.points, of_each);
  json["reversal"] = {{"steps", v.reversal.steps}, {"distance", v.reversal.distance}};
  return json_text(json);
}

}  // namespace delf
