// SPDX-License-Identifier: MIT
#include "tools/scene/recorded_scene.hpp"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "lattice/text_parts.hpp"
#include "schemes/declared.hpp"
#include "schemes/driven_ends.hpp"

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

namespace {

[[noreturn]] void refuse(const std::string& file, const std::string& key, const std::string& there,
                         const std::string& here) {
  throw BadScene(
      fmt::format("command line: --fields {}: was made with {} = {}, and the scene has {}; use --{}={}, or leave out "
                  "its attribute "
                  "scene",
                  file, key, there, here, key, there));
}

std::string name_of(const Problem& p, const char* key, Wall wall) {
  if (const auto motion = p.parameters.maybe<std::string>(key)) return *motion;
  return wall == Wall::natural ? "natural" : wall == Wall::clamped ? "clamped" : "fixed";
}

// Requires the space of recorded rows: a circle or an interval, and its walls.
void require_recorded_space(const Scene& scene, const std::string& file,
                            const std::map<std::string, std::string>& recorded) {
  const Lattice& lattice = scene.problem.lattice;
  const bool interval = lattice.space() == Space::interval;
  const auto require = [&](const char* key, const std::string& here) {
    if (const auto there = recorded.find(key); there != recorded.end() && there->second != here)
      refuse(file, key, there->second, here);
  };
  require("lattice.space", lattice.space() == Space::point ? "point" : interval ? "interval" : "circle");
  if (!interval) return;
  require(left_end, name_of(scene.problem, left_end, lattice.left()));
  require(right_end, name_of(scene.problem, right_end, lattice.right()));
}

}  // namespace

std::string recorded_otherwise(const Scene& scene, const std::string& scene_text) {
  const auto recorded = recorded_keys(scene_text);
  const auto differs = [&](const char* key, const std::string& here) {
    const auto there = recorded.find(key);
    return there == recorded.end() || there->second == here
               ? std::string()
               : fmt::format(", recorded with {} = {}", key, there->second);
  };
  const std::string method = differs("scheme.method", scene.problem.method);
  if (!method.empty() || !find_method(scene.problem.method).reads_stencil) return method;
  return differs("lattice.stencil", scene.problem.stencil);
}

void require_recorded_parameters(const Scene& scene, const std::string& file, const std::string& scene_text) {
  const auto recorded = recorded_keys(scene_text);
  const auto name = recorded.find("theory.name");
  if (name == recorded.end() || name->second != scene.problem.theory) return;
  require_recorded_space(scene, file, recorded);
  for (const auto& [key, there] : recorded) {
    if (!key.starts_with("theory.") || !scene.problem.parameters.has(key)) continue;
    ParameterValues values = scene.problem.parameters;
    const ParameterValue here = values[key];
    if (std::holds_alternative<std::string>(here)) continue;  // one formula may be written in many ways
    const double number = *values.maybe<double>(key);
    char* end = nullptr;
    const double other = std::strtod(there.c_str(), &end);
    if (*end != '\0' || std::abs(other - number) <= 1e-12 * std::abs(number)) continue;
    refuse(file, key, there, to_text(here));
  }
}

}  // namespace delf
