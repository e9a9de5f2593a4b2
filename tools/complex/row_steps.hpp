// SPDX-License-Identifier: MIT
#pragma once
#include <optional>

#include "schemes/complex/reversible_steps.hpp"
#include "tools/complex/complex_scene.hpp"

namespace delf {

/// The lengths of a scene's steps, one after the other: all the same, a list over and over, or those that the field chooses.
class RowSteps {
 public:
  explicit RowSteps(const ComplexScene&);

  /// Rows 0 and 1.
  void start(SpaceEvolution&);
  void step(SpaceEvolution&);
  /// Where the field chooses: the shorter of the first step and what the row behind it asks for.
  std::optional<double> first_lengths(const SpaceEvolution&) const;
  /// Further steps go back by the lengths of those that were taken.
  void turn_back(SpaceEvolution&);
  void visit(SavedState&);

 private:
  void check(const SpaceEvolution&) const;

  const ComplexScene& scene_;
  std::optional<ReversibleSteps> reversible_;
  std::int64_t next_ = 0;  ///< place of a step's length in the list
  int direction_ = 1;
};

}  // namespace delf
