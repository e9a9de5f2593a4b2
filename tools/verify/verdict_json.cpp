// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "tools/outcome/findings_json.hpp"
#include "tools/scene/keys.hpp"
#include "tools/scene/values.hpp"
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

/// The keys that rows depend on, as a resolved scene has them: they tell whose verification it is.
Json settings_of(const Scene& scene) {
  const Problem& p = scene.problem;
  Json settings = Json::object();
  const auto is_of_rows = [](const std::string& key) {
    // names of files are written in many ways, and the rule of the first rows is chosen with them
    for (const char* other : {"initial.start", "initial.file", "lattice.mesh", "lattice.time_steps", "lattice.courant",
                              "lattice.first_row", "run.until", "run.steps"})
      if (key == other) return false;
    const auto section = section_of(key);
    return section == "theory" || section == "lattice" || section == "scheme" || section == "initial" ||
           key == "run.seed";
  };
  for (const Parameter& key : scene.settings.all_keys())
    if (is_of_rows(key.key))
      if (const auto value = Values(scene.settings).text(key.key)) settings[key.key] = *value;
  if (!p.stencil.empty()) settings["lattice.stencil"] = p.stencil;
  if (p.time_step > 0) settings["lattice.time_step"] = fmt::format("{}", p.time_step);
  if (settings.contains("scheme.tolerance") && Values(scene.settings).real("scheme.tolerance") < p.tolerance)
    settings["scheme.tolerance"] = fmt::format("{}", p.tolerance);
  if (scene.until) settings["run.until"] = Values(scene.settings).text("run.until").value_or("");
  else settings["run.steps"] = fmt::format("{}", scene.steps);
  return settings;
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
  json["settings"] = settings_of(scene);
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
