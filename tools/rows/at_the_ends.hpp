// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "schemes/state.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// The change of a state by the ends of space, in units of the field, and what it does there.
struct EndChange {
  double change = 0;
  std::string words;  ///< "jumps where the circle closes"
};

/// The distance of a state from what the ends of space make of it; at all times of the run where it is a solution.
struct AtTheEnds {
  EndChange value;  ///< the jump where a circle closes, or the motion of a fixed wall, or beside a driven end
  EndChange slope;  ///< slopes at natural walls, corners of a circle, rates at fixed walls: times the time that they act
  const EndChange& larger() const { return slope.change > value.change ? slope : value; }
};
AtTheEnds at_the_ends(const Scene&, const State&);

}  // namespace delf
