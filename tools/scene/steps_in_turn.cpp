// SPDX-License-Identifier: MIT
#include "tools/scene/steps_in_turn.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "jets/expressions/expression.hpp"
#include "lattice/text_parts.hpp"
#include "tools/scene/file_beside.hpp"

namespace delf {

namespace {

namespace fs = std::filesystem;
constexpr const char* key = "lattice.time_steps";

double step_of(const Settings& settings, const std::string& text, const std::string& place, const char* remedy) {
  double step = 0;
  try {
    step = number_of(text, key);
  } catch (const BadInput&) {
    throw settings.error(key, fmt::format("{}\"{}\" is no number; {}", place, text.substr(0, 40), remedy));
  }
  if (!std::isnormal(step) || step < 0)
    throw settings.error(key, fmt::format("{}{} is no step: steps must be above 0, and finite", place, text));
  return step;
}

std::vector<double> steps_in_file(const Settings& settings, const fs::path& path) {
  std::error_code none;
  if (!fs::is_regular_file(path, none)) throw settings.error(key, "is no regular file; name a file of steps");
  std::ifstream in(path);
  if (!in) throw settings.error(key, "cannot be read; check its permissions");
  std::vector<double> steps;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    std::string content = trimmed(line.substr(0, line.find('#')));
    if (content.ends_with(',')) content = trimmed(content.substr(0, content.size() - 1));
    if (content.empty()) continue;
    for (const std::string& part : parts_of(content))
      steps.push_back(step_of(settings, part, fmt::format("line {}: ", number), "give steps like 0.1, 0.05"));
  }
  if (steps.empty()) throw settings.error(key, "is a file without steps; give one, such as 0.1, on each line");
  return steps;
}

}  // namespace

std::vector<double> steps_in_turn(const Settings& settings, const std::string& text) {
  if (const auto path = file_beside(settings, text)) return steps_in_file(settings, *path);
  std::vector<double> steps;
  for (const std::string& part : parts_of(text))
    steps.push_back(step_of(settings, part, "", "give steps like 0.1, 0.05, or a file of them"));
  return steps;
}

}  // namespace delf
