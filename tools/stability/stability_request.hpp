// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "schemes/simulation.hpp"
#include "tools/stability/observed_limit.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// A request to `delf stability`.
struct StabilityRequest {
  std::vector<NamedScheme> schemes;
  bool own_waves = false;  ///< limits are those of the scene's own theory: no maps, dispersion and stress cases then
  std::vector<double> mass_steps{0.5, 1, 2.3};  ///< mh at which limits are found
  LimitRequest limit;
  std::vector<std::string> corners;  ///< groups
  double budget = 1;                 ///< seconds for a stress case
  bool map = true;
};

/// Names separated by commas; those between brackets do not count: "guo, spacetime (2,2) gauss".
std::vector<std::string> names_in_list(const std::string& text);
/// The schemes of those names, "all", or if there is no name the usual ones. Throws BadInput (stability.schemes).
std::vector<NamedScheme> chosen_schemes(const std::vector<std::string>& names, const Problem& base);

/// What stability.waves may be.
const std::vector<std::string>& stability_waves();
/// Faults that can be planted.
const std::vector<std::string>& stability_faults();

/// The [stability] keys of a scene. Throws BadScene.
StabilityRequest read_stability_request(const Scene&);

}  // namespace delf
