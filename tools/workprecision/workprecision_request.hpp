// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tools/scene/scene.hpp"

namespace delf {

/// A request to `delf workprecision`: the [workprecision] keys of a scene.
struct WorkPrecisionRequest {
  std::vector<std::string> schemes;  ///< names of schemes, methods or peers; empty: all
  std::vector<int> sites;            ///< N of the ladder; empty: chosen
  std::vector<double> courants;      ///< h/k; empty: chosen, or with `sites` the scene's own
  std::vector<double> accuracies{1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10};  ///< L∞, falling
  int repeats = 5;         ///< timed runs of each resolution
  double budget = 100;     ///< seconds that all of it may take, nearly
  bool peers = true;       ///< other programs too
  double until = 0;        ///< time of the last row
  std::uint64_t seed = 1;  ///< of the order in which runs are timed
};

/// Throws BadScene.
WorkPrecisionRequest read_workprecision_request(const Scene&);

}  // namespace delf
