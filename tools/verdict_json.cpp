// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "tools/verdict.hpp"

namespace delf {

namespace {

using Json = nlohmann::ordered_json;

Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

Json json_of(const Check& c) {
  return {{"name", c.name},           {"region", c.region},         {"value", c.value},
          {"tolerance", c.tolerance}, {"normaliser", c.normaliser}, {"count", c.count},
          {"samples", c.samples},     {"passed", c.passed()},       {"failure", c.passed() ? Json() : Json(c.failure)}};
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

Json json_of(const RegionPoint& p) {
  return {
      {"kind", p.kind}, {"stencils", p.stencils}, {"value", p.value}, {"variations", p.local ? "local" : "evolved"}};
}

template <class List>
Json list_of(const List& all) {
  Json list = Json::array();
  for (const auto& one : all) list.push_back(json_of(one));
  return list;
}

}  // namespace

std::string verdict_json(const Scene& scene, const Verdict& v) {
  const Problem& p = scene.problem;
  Json json;
  json["version"] = DELF_VERSION;
  json["scene"] = scene.name;
  json["theory"] = p.theory;
  json["stencil"] = p.stencil;
  json["method"] = p.method;
  json["sites"] = p.lattice.sites();
  json["time_step"] = p.time_step;
  json["seed"] = v.seed;
  json["subject"] = v.subject;
  json["status"] = v.status;
  json["seconds"] = v.seconds;
  json["stencils"] = v.stencils;
  json["passed"] = v.passed();
  json["checks"] = list_of(v.checks);
  json["measured"] = list_of(v.measured);
  json["left_out"] = v.left_out;
  json["regions"] = list_of(v.points);
  json["reversal"] = {{"steps", v.reversal.steps}, {"distance", v.reversal.distance}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace delf
