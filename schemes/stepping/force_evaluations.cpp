// SPDX-License-Identifier: MIT
#include "schemes/stepping/force_evaluations.hpp"

#include <algorithm>
#include <limits>
#include <tuple>
#include <vector>

namespace delf {
namespace {

using Part = std::tuple<int, int, int, int, double>;  // time and space from the first, node, component, weight

/// The inputs of a group, from wherever it lies: the first vertex of all is the origin.
std::vector<std::vector<Part>> shape_of(const SourceTerms::Group& group) {
  int time = std::numeric_limits<int>::max(), space = time;
  for (const auto& input : group.inputs)
    for (const SourceTerms::Part& part : input)
      time = std::min(time, part.vertex.time), space = std::min(space, part.vertex.space);
  std::vector<std::vector<Part>> shape;
  for (const auto& input : group.inputs) {
    shape.emplace_back();
    for (const SourceTerms::Part& part : input)
      shape.back().emplace_back(part.vertex.time - time, part.vertex.space - space, part.vertex.node, part.component,
                                part.weight);
    std::ranges::sort(shape.back());
  }
  return shape;
}

}  // namespace

double forces_in_a_pass(const LatticeSystem& system) {
  double forces = 0;
  for (const auto& family : system.families()) {
    const SourceTerms* sources = family->sources();
    if (!sources || family->pattern().is_of_wall()) continue;
    std::vector<std::vector<std::vector<Part>>> shapes;
    for (const SourceTerms::Group& group : sources->groups)
      if (const auto shape = shape_of(group); std::ranges::count(shapes, shape) == 0) shapes.push_back(shape);
    forces += static_cast<double>(shapes.size()) * (family->pattern().placement == Placement::brick_wall ? 0.5 : 1);
  }
  return forces > 0 ? forces : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace delf
