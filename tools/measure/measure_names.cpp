// SPDX-License-Identifier: MIT
#include "tools/measure/measure_names.hpp"

#include <nlohmann/json.hpp>

#include "jets/expressions/parse.hpp"
#include "tools/outcome/outcome.hpp"

namespace delf {

namespace {

constexpr std::string_view section = "measure.";

nlohmann::json any_summary(const Scene& scene) {
  Outcome outcome;
  outcome.error_estimate.emplace();  // or its name would not be there
  return nlohmann::json::parse(summary_json(subject_of(scene.problem), scene, outcome));
}

}  // namespace

std::vector<std::string> measure_names(const Settings& settings) {
  std::vector<std::string> names;
  for (const DeclaredKey& own : settings.declared())
    if (own.parameter.key.starts_with(section)) names.push_back(own.parameter.key.substr(section.size()));
  return names;
}

std::string key_of_measure(const std::string& name) { return std::string(section) + name; }

void check_measure_names(const Scene& scene) {
  const std::vector<std::string> names = measure_names(scene.settings);
  if (names.empty()) return;
  const nlohmann::json summary = any_summary(scene);
  for (const std::string& name : names) {
    const std::string key = key_of_measure(name);
    try {
      expressions::check_new_name(name, {}, key);
      if (summary.contains(name))
        throw BadInput(key, key + ": \"" + name + "\" is a name of summary.json; choose another");
    } catch (const BadInput& bad) {
      throw scene.settings.located(bad);
    }
  }
}

}  // namespace delf
