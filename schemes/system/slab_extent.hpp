// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <vector>

#include "lattice/plan/solve_plan.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// The rows around row J in which the unknowns and the equations of slab J are.
struct SlabExtent {
  int below = 0;          ///< rows from its lowest unknown up to row J
  int history = 0;        ///< rows before row J that its equations contain
  int above = 0;          ///< rows from row J up to its highest unknown
  int field_lag = 0;      ///< rows from the lowest unknown field up to row J: the newest whole row is J − field_lag
  int equation_lag = 0;   ///< rows from its lowest equation up to row J
  int equation_lead = 0;  ///< rows from row J up to its highest equation
  /// The number of rows that the newest known value of each component is behind the newest whole row of fields.
  std::vector<int> behind;

  /// Rows before row J that must be there.
  int past() const { return std::max({history, below, 1}); }
};
SlabExtent slab_extent(const LatticeSystem&, const SolvePlan&);

}  // namespace delf
