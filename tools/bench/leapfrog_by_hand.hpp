// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "schemes/stepping/rows/row_layout.hpp"

namespace delf::bench {

/// What the explicit scheme cannot be faster than, short of several steps at a time: the least a step must do, written
/// by hand for it alone, with the engine's packs, sine and layout of rows.
///
///     v += (h/k)² ∂²_k y − h² sin y,   y += v
class LeapfrogByHand {
 public:
  LeapfrogByHand(const Lattice&, double time_step);
  void start(const std::vector<double>& row0, const std::vector<double>& row1);
  void step();
  std::vector<double> row() const;

 private:
  RowLayout layout_;
  RowBuffer rows_;  ///< y, v
  double squared_ratio_, squared_step_;
};

}  // namespace delf::bench
