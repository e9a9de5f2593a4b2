// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "schemes/simulation.hpp"

namespace delf {

/// What the columns of recorded rows, and of the series, are called.
struct RowNames {
  RowNames() = default;
  explicit RowNames(const Simulation&);

  std::vector<std::string> field{"phi"}, inner, multiplier;
  std::vector<std::string> further;  ///< columns of series.csv after the residual
  std::optional<std::size_t> mesh;   ///< the field that is the position of the nodes

  /// One field at the vertices, and nothing else.
  bool plain() const { return field.size() == 1 && inner.empty() && multiplier.empty(); }
};

}  // namespace delf
