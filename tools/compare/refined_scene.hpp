// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "tools/compare/placed_row.hpp"
#include "tools/measure/measures.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// The scene at 1/factor of its steps in time and space, recorded at the same times; the end of the run is the same.
Scene refined(const Scene&, int factor = 2);

/// A row of that scene, [i·d + a], at the sites of the given one.
std::vector<double> at_sites_of(const Scene&, const std::vector<double>& refined_row, int factor = 2);

/// The end of a run that writes nothing.
struct QuietEnd {
  std::vector<double> row;  ///< of the fields, [i·d + a]
  PlacedRow placed;         ///< the same where sites move; else empty
  std::vector<NamedNumber> measures;
  double time = 0;        ///< of that row
  double seconds = 0;     ///< of the steps alone
  bool finished = false;  ///< not if interrupted
};
/// Steps a scene to its end. Throws BadInput and NumericalFailure.
QuietEnd run_quietly(const Scene&);

}  // namespace delf
