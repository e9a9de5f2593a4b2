// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <vector>

#include "schemes/solvers/block_solver.hpp"

namespace delf {

/// Rows and columns of a matrix in groups round a circle, as many of each in every group, such that an entry lies in one
/// group or between neighbours.
struct SiteGroups {
  using Entries = BlockSolver::Entries;
  std::vector<int> of_row, of_column;
  std::vector<int> sizes;

  int count() const { return static_cast<int>(sizes.size()); }

  /// By the sites where rows and columns belong; nothing where entries reach too far, or rows and columns do not pair.
  static std::optional<SiteGroups> of(const std::vector<int>& row_sites, const std::vector<int>& column_sites, Entries);

 private:
  int reach(Entries) const;
  /// As many neighbours in one group as it takes.
  void merge(int together);
};

}  // namespace delf
