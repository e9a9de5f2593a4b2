// SPDX-License-Identifier: MIT
#include "tools/workprecision/workprecision_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>

#include "tools/scene/values.hpp"

namespace delf {

namespace {

// Numbers of a key, separated by commas or blanks.
std::vector<double> numbers(const Scene& scene, const char* key) {
  const std::string text = Values(scene.settings).text(key).value_or("");
  std::vector<double> all;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find_first_of(", \t", begin), text.size());
    if (end > begin) {
      double number = 0;
      const auto [stop, error] = std::from_chars(text.data() + begin, text.data() + end, number);
      if (error != std::errc() || stop != text.data() + end || !(number > 0) || !std::isfinite(number))
        throw scene.settings.error(key, fmt::format("\"{}\" is no positive number; write numbers separated by commas",
                                                    text.substr(begin, end - begin)));
      all.push_back(number);
    }
    begin = end + 1;
  }
  return all;
}

}  // namespace

std::vector<std::string> names_in(const std::string& text) {
  std::vector<std::string> names(1);
  int depth = 0;
  for (const char c : text) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c == ',' && depth == 0) names.emplace_back();
    else names.back() += c;
  }
  for (std::string& name : names) {
    name.erase(0, std::min(name.size(), name.find_first_not_of(" \t")));
    name.erase(name.find_last_not_of(" \t") + 1);
  }
  std::erase(names, "");
  return names;
}

WorkPrecisionRequest read_workprecision_request(const Scene& scene) {
  const Values values(scene.settings);
  WorkPrecisionRequest request;
  request.schemes = names_in(values.text("workprecision.schemes").value_or(""));
  if (request.schemes.empty() && values.given("workprecision.schemes"))
    throw scene.settings.error("workprecision.schemes", "names no scheme; write names separated by commas, or all");
  if (request.schemes == std::vector<std::string>{"all"}) request.schemes.clear();
  for (const double n : numbers(scene, "workprecision.sites")) {
    constexpr double most = 1e9;
    if (n != std::floor(n) || n < 2 || n > most)
      throw scene.settings.error("workprecision.sites", fmt::format("{:g} is no number of sites; use 2 or more", n));
    request.sites.push_back(static_cast<int>(n));
  }
  if (!request.sites.empty() && scene.problem.lattice.space() == Space::point)
    throw scene.settings.error("workprecision.sites", "a point has no sites; leave it out");
  request.courants = numbers(scene, "workprecision.courants");
  if (!request.courants.empty() && scene.problem.lattice.space() == Space::point)
    throw scene.settings.error("workprecision.courants", "a point has no space step; leave it out");
  if (auto asked = numbers(scene, "workprecision.accuracies"); !asked.empty()) request.accuracies = std::move(asked);
  std::ranges::sort(request.accuracies, std::greater());
  request.repeats = static_cast<int>(values.integer("workprecision.repeats"));
  request.budget = values.real("workprecision.budget");
  request.peers = values.toggle("workprecision.peers");
  request.seed = scene.initial.seed;
  if (scene.problem.step_control)
    throw scene.settings.error(
        "lattice.time_steps",
        "reversible steps end at times of their own, and schemes are compared at one; leave it out");
  request.until = values.given("run.until") && !values.given("run.steps")
                      ? values.real("run.until")
                      : static_cast<double>(scene.steps) * scene.problem.time_step;
  if (!(request.until > 0))
    throw scene.settings.error(values.given("run.steps") ? "run.steps" : "run.until",
                               "nothing is stepped, so nothing takes time; use more");
  return request;
}

}  // namespace delf
