// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "lattice/lattice.hpp"
#include "tools/verify/verdict.hpp"

namespace delf {

/// The largest residual in each of some hundred bins of time and space: a figure of any number of rows.
class ResidualBins {
 public:
  ResidualBins(const Lattice&, double time_step, std::int64_t first_row, std::int64_t rows);

  /// Adds a row: [i·components + c], not a number where there is no equation.
  void add(std::int64_t row, const std::vector<double>& residuals, int components);
  ResidualMap map() const;

 private:
  static constexpr std::int64_t most = 200;
  const Lattice& lattice_;
  double time_step_;
  std::int64_t first_, rows_, row_bins_;
  int site_bins_;
  std::vector<double> largest_;  ///< not a number while no equation has been seen
};

}  // namespace delf
