// SPDX-License-Identifier: MIT
#include "tools/run/tiny_steps.hpp"

#include <fmt/format.h>

namespace delf {

void refuse_tiny_steps(const Scene& scene, double first_step, const std::string& speed) {
  constexpr double most = 1000;
  if (!scene.problem.step_control || first_step * most >= scene.problem.time_step) return;
  throw scene.settings.error(
      "lattice.step_control",
      fmt::format("makes the first step {:.3g}, which is lattice.time_step = {:.3g} over sqrt(1 + s^2 {}); "
                  "use s of 0.1 to 10, and a shorter lattice.time_step for shorter steps",
                  first_step, scene.problem.time_step, speed));
}

}  // namespace delf
