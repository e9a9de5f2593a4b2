// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <vector>

#include "jets/batch_density.hpp"
#include "lattice/lattice.hpp"

namespace delf {

/// The jets in the middle of the cells between two rows of fields, [i·d + a] each: those of the symmetric rectangle, with
/// whatever scheme the rows were made,
///
///     φ = ¼ Σ of the corners,   φ_t = (z_i + z_{i+1} − y_i − y_{i+1})/2h,   φ_x = (y_{i+1} + z_{i+1} − y_i − z_i)/2k
///
/// and for densities of second order also
///
///     φ_tx = (z_{i+1} − z_i − y_{i+1} + y_i)/hk,   φ_xx = the mean of (y_{i−1} − 2y_i + y_{i+1})/k² at the corners
///
/// (at a wall, where it has no second neighbour, a corner has the value of the next site). φ_tt is not a number: two rows
/// do not know it.
class CellJets {
 public:
  /// `monodromy` is φ(x + L) − φ(x) on a circle. A density has 3 or 6 slots.
  CellJets(const BatchDensity&, const Lattice&, double time_step, double monodromy);

  /// slot s of component a is [s·d + a]. Valid until the next call.
  const double* at(int cell, std::span<const double> below, std::span<const double> above);

 private:
  double value(std::span<const double> row, int site, int component) const;
  double second_difference(std::span<const double> row, int site, int component) const;

  Lattice lattice_;
  int components_;
  double time_step_, monodromy_;
  bool second_order_;
  std::vector<double> jet_;
};

}  // namespace delf
