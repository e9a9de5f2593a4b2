// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "schemes/system/lattice_system.hpp"

namespace delf {

class Assembly;

/// LatticeSystem::equations() of one row after another: what a row's stencils read, and where their residuals go, is listed
/// once, which costs ten times an evaluation. Copies share the lists.
class AssembledRow {
 public:
  explicit AssembledRow(const LatticeSystem& system) : system_(&system) {}

  /// E of every site and component of a row, [i·C + c], whether it is an equation there or not. The monodromy of all windows is
  /// that of the first.
  void equations(const Window&, std::int64_t row, std::vector<LatticeSystem::Value>& values);

 private:
  const LatticeSystem* system_;
  std::array<std::shared_ptr<const Assembly>, 2> of_parity_;  ///< of rows; brick walls alone have two kinds
};

}  // namespace delf
