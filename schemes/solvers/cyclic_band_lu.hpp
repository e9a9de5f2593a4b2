// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/LU>
#include <optional>
#include <vector>

#include "lattice/index.hpp"
#include "lattice/lattice.hpp"
#include "lattice/matrix_entry.hpp"

namespace delf {

/// The distance of entries from the diagonal, the shorter way round where space is a circle.
struct Bandwidth {
  int lower = 0, upper = 0;
};
Bandwidth bandwidth(const Lattice&, int size, const std::vector<MatrixEntry>& entries);

/// LU of a band matrix, with corners when space is a circle: the last m unknowns are a border, so that what is left is
/// a plain band, factored without pivoting.
///
///     ( B  F ) (x)   (r)          Z = B⁻¹F,  S = H − G Z
///     ( G  H ) (z) = (s)          z = S⁻¹(s − G B⁻¹r),  x = B⁻¹r − Z z
///
class CyclicBandLU {
 public:
  /// Nothing if the band would wrap onto itself, or a pivot is so small that pivoting would be needed.
  static std::optional<CyclicBandLU> factor(int size, Bandwidth, bool cyclic, const std::vector<MatrixEntry>& entries);
  void solve(std::vector<double>& x) const;
  std::size_t bytes() const {
    return sizeof(double) *
           (lower_band_.size() + upper_band_.size() + pivot_.size() + at(Z_.size() + border_rows_.size()));
  }

 private:
  void solve_band(double* x) const;

  int plain_ = 0, border_ = 0, lower_ = 0, upper_ = 0;
  std::vector<double> lower_band_, upper_band_, pivot_;  ///< multipliers; U above its diagonal; 1/diagonal
  Eigen::MatrixXd Z_, border_rows_;                      ///< B⁻¹F; G, its first and last columns only
  std::vector<int> border_columns_;
  Eigen::PartialPivLU<Eigen::MatrixXd> schur_;
};

}  // namespace delf
