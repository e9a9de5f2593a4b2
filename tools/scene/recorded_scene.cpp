// SPDX-License-Identifier: MIT
#include "tools/scene/recorded_scene.hpp"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "lattice/text_parts.hpp"
#include "schemes/declared.hpp"

namespace delf {

std::map<std::string, std::string> recorded_keys(const std::string& scene_text) {
  std::map<std::string, std::string> keys;
  std::istringstream lines(scene_text);
  std::string section;
  for (std::string line; std::getline(lines, line);) {
    line = trimmed(line.substr(0, line.find('#')));
    const std::size_t equals = line.find('=');
    if (line.starts_with('[')) section = trimmed(line.substr(1, line.find(']') - 1)) + ".";
    else if (equals != std::string::npos)
      keys[section + trimmed(line.substr(0, equals))] = trimmed(line.substr(equals + 1));
  }
  return keys;
}

void require_recorded_parameters(const Scene& scene, const std::string& file, const std::string& scene_text) {
  const auto recorded = recorded_keys(scene_text);
  const auto name = recorded.find("theory.name");
  if (name == recorded.end() || name->second != scene.problem.theory) return;
  for (const auto& [key, there] : recorded) {
    if (!key.starts_with("theory.") || !scene.problem.parameters.has(key)) continue;
    ParameterValues values = scene.problem.parameters;
    const ParameterValue here = values[key];
    if (std::holds_alternative<std::string>(here)) continue;  // one formula may be written in many ways
    const double number = *values.maybe<double>(key);
    char* end = nullptr;
    const double other = std::strtod(there.c_str(), &end);
    if (*end != '\0' || std::abs(other - number) <= 1e-12 * std::abs(number)) continue;
    throw BadScene(
        fmt::format("command line: --fields {}: was made with {} = {}, and the scene has {}; use --{}={}, or leave out "
                    "its attribute "
                    "scene",
                    file, key, there, to_text(here), key, there));
  }
}

}  // namespace delf
