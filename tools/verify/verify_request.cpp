// SPDX-License-Identifier: MIT
#include "tools/verify/verify_request.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "jets/expressions/generator.hpp"
#include "tools/scene/lists.hpp"
#include "tools/scene/suggestion.hpp"
#include "tools/scene/values.hpp"
#include "tools/verify/region_text.hpp"

namespace delf {

bool VerifyRequest::wants(std::string_view check) const { return std::ranges::find(checks, check) != checks.end(); }

const std::vector<std::string>& verify_checks() {
  static const std::vector<std::string> all{"equations", "forms",       "noether", "balance",
                                            "reversal",  "derivatives", "newton"};
  return all;
}

VerifyRequest read_verify_request(const Scene& scene) {
  const Values values(scene.settings);
  VerifyRequest request;
  for (const std::string& word : words_in(values.text("verify.regions").value_or(""))) {
    const auto& kinds = region_kinds();
    const auto kind = std::ranges::find_if(kinds, [&](RegionKind k) { return word == to_string(k); });
    if (kind != kinds.end()) request.regions.push_back({word, *kind, {}});
    else if (word.find_first_of("0123456789") != std::string::npos) {
      try {
        request.regions.push_back({"given " + word, std::nullopt, sites_of_region(word, scene.problem.lattice)});
      } catch (const BadInput& bad) {
        throw scene.settings.located(bad);
      }
    } else {
      std::vector<std::string> names;
      for (const RegionKind k : kinds) names.emplace_back(to_string(k));
      throw scene.settings.error("verify.regions",
                                 fmt::format("{} is no kind of region{}; or write ROWSxSITES, such as "
                                             "0:8x10:30",
                                             word, suggestion(word, names)));
    }
  }
  if (request.regions.empty())
    for (const RegionKind kind : region_kinds()) request.regions.push_back({to_string(kind), kind, {}});

  request.checks = words_in(values.text("verify.checks").value_or(""));
  request.chosen = !request.checks.empty();
  for (const std::string& check : request.checks)
    if (std::ranges::find(verify_checks(), check) == verify_checks().end())
      throw scene.settings.error("verify.checks",
                                 fmt::format("{} is no check{}", check, suggestion(check, verify_checks())));
  if (!request.chosen) request.checks = verify_checks();
  request.variations = static_cast<int>(values.integer("verify.variations"));
  request.moments = static_cast<int>(values.integer("verify.moments"));
  request.tolerance = values.real("verify.tolerance");
  request.own_tolerance = values.given("verify.tolerance");
  request.generator = values.text("verify.generator").value_or("");
  request.force = values.toggle("verify.force");
  request.identify = values.toggle("verify.identify");
  request.unwrap = values.toggle("verify.unwrap");
  request.fault = values.choice("verify.fault");
  return request;
}

void add_generator(const Scene& scene, const std::string& text, const std::vector<std::string>& fields,
                   std::vector<LinearSymmetry>& all) {
  if (text.empty()) return;
  try {
    all.push_back(generator_of(text, {fields, {}}, "generator (" + text + ")", "verify.generator"));
  } catch (const BadInput& bad) {
    throw scene.settings.located(bad);
  }
}

}  // namespace delf
