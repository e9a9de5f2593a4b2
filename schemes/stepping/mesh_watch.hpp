// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "schemes/system/assembly.hpp"

namespace delf {

/// Watches a mesh that moves, where a component is the position of the sites. Newton's method is content with a tangled one,
/// since the equations do not know which site comes first.
class MeshWatch {
 public:
  explicit MeshWatch(const LatticeSystem&);

  /// The first of two neighbouring sites that have passed each other in a row.
  std::optional<int> crossing(const double* row) const;
  /// Says in words if cells have turned over in a row, or at a stage of the step that led there; empty if not.
  std::string crossing_at(const SectionRing&, std::int64_t row) const;
  /// "sites 5 and 6 are 0.0073 apart, closer than any others"
  std::string narrowest_cell(const double* row) const;

 private:
  const LatticeSystem& system_;
  std::vector<const StencilFamily*> stages_;  ///< that have cells
};

}  // namespace delf
