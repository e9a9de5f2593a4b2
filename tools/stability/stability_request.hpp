// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "schemes/simulation.hpp"
#include "tools/scene/scene.hpp"
#include "tools/stability/observed_limit.hpp"

namespace delf {

/// A request to `delf stability`.
struct StabilityRequest {
  std::vector<NamedScheme> schemes;
  std::string
      own_left_out;        ///< in words, where the scene's own scheme can not be among them and no others are asked for
  bool own_waves = false;  ///< limits are those of the scene's own theory: no maps, dispersion and stress cases then
  std::vector<double> mass_steps{0.5, 1, 2.3};  ///< mh at which limits are found
  LimitRequest limit;
  std::vector<std::string> stress_cases;  ///< groups
  double budget = 1;                 ///< seconds for a stress case
  bool map = true;
};

/// The names of a key of the scene; empty if it is not given. Throws BadScene if it is, and names none.
std::vector<std::string> listed_names(const Scene&, const char* key);
/// Adds it, unless one of its name is there.
void add_once(std::vector<NamedScheme>&, const NamedScheme&);
/// The schemes of those names, once each, "all", or if there is no name the usual ones. Throws BadInput
/// (stability.schemes).
std::vector<NamedScheme> chosen_schemes(const std::vector<std::string>& names, const Problem& base);

/// The [stability] keys of a scene. Throws BadScene.
StabilityRequest read_stability_request(const Scene&);

}  // namespace delf
