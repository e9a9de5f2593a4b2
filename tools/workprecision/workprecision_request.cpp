// SPDX-License-Identifier: MIT
#include "tools/workprecision/workprecision_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "schemes/driven_ends.hpp"
#include "tools/scene/lists.hpp"
#include "tools/scene/values.hpp"

namespace delf {

WorkPrecisionRequest read_workprecision_request(const Scene& scene) {
  const Values values(scene.settings);
  WorkPrecisionRequest request;
  request.schemes = names_in(values.text("workprecision.schemes").value_or(""));
  if (request.schemes.empty() && values.given("workprecision.schemes"))
    throw scene.settings.error("workprecision.schemes", "names no scheme; write names separated by commas, or all");
  if (request.schemes == std::vector<std::string>{"all"}) request.schemes.clear();
  for (const double n : positive_numbers(scene.settings, "workprecision.sites")) {
    constexpr double most = 1e9;
    if (n != std::floor(n) || n < 2 || n > most)
      throw scene.settings.error("workprecision.sites", fmt::format("{:g} is no number of sites; use 2 or more", n));
    request.sites.push_back(static_cast<int>(n));
  }
  if (!request.sites.empty() && scene.problem.lattice.space() == Space::point)
    throw scene.settings.error("workprecision.sites", "a point has no sites; leave it out");
  request.courants = positive_numbers(scene.settings, "workprecision.courants");
  if (!request.courants.empty() && scene.problem.lattice.space() == Space::point)
    throw scene.settings.error("workprecision.courants", "a point has no space step; leave it out");
  if (auto asked = positive_numbers(scene.settings, "workprecision.accuracies"); !asked.empty())
    request.accuracies = std::move(asked);
  std::ranges::sort(request.accuracies, std::greater());
  request.repeats = static_cast<int>(values.integer("workprecision.repeats"));
  request.budget = values.real("workprecision.budget");
  request.peers = values.toggle("workprecision.peers");
  request.seed = scene.initial.seed;
  if (const std::string end = key_of_driven_end(scene.problem); !end.empty())
    throw scene.settings.error(end, "schemes are compared between ends at rest; leave it out");
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
