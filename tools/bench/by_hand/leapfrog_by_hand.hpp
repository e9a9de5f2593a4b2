// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "schemes/solvers/row_layout.hpp"

namespace delf::bench {

/// A lower bound for the explicit scheme, short of several steps at a time: the least work of a step, written by hand,
/// with the engine's packs, sine and layout of rows.
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
