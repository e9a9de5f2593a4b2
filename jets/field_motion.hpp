// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "jets/batch_density.hpp"
#include "lattice/index.hpp"

namespace delf {

/// The facts proved of d fields: which occur in field equations, which there have derivatives in time, and which are
/// coupled. A field that nothing moves has no equation that a step could solve for it.
struct FieldMotion {
  std::vector<bool> present, moving;
  std::vector<std::vector<bool>> coupled;

  explicit FieldMotion(int d) : present(at(d)), moving(present), coupled(present.size(), present) {}

  /// One more density of the same fields.
  void add(const BatchDensity&);
  /// A field that is coupled to one that moves is determined with it: a constraint's multiplier, say.
  void spread();
};

}  // namespace delf
