// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <vector>

#include "jets/simd/pack.hpp"

namespace delf {

/// A band matrix and its LU with partial pivoting: row k takes the largest pivot of the rows k … k + lower, so that U
/// has lower + upper diagonals above the main one. Columns lie at absolute places modulo a pack: what one row has
/// stored is loaded from the same addresses by the next.
class BandLU {
 public:
  BandLU(int n, int lower, int upper);

  /// The place of A_ij in numbers(), of doubles.
  int place(int i, int j) const { return base_[i] + j; }
  double* numbers() { return reinterpret_cast<double*>(rows_.data()); }
  void set_zero();

  /// A = P L U in place. False if a pivot is zero or not finite.
  bool factor();
  /// x ← A⁻¹ x. Allocates nothing.
  void solve(double* x) const;
  std::size_t bytes() const;

 private:
  const double* numbers() const { return reinterpret_cast<const double*>(rows_.data()); }

  int n_, lower_, upper_;
  std::vector<Pack> rows_;
  std::vector<int> base_, pivot_;
  std::vector<double> multipliers_;  ///< [k·lower + i] of row k + 1 + i
  std::vector<double> inverse_;      ///< 1/U_kk
};

}  // namespace delf
